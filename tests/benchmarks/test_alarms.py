"""The benchmark of alarms: kinds of references, outcomes and scores, and verdicts that it does not know keep their names."""

from itertools import product

import numpy as np
import pytest
import xarray as xr

from benchmarks import alarms
from benchmarks.alarms import ALL, ALONE, OUTCOMES, Answered, counted, healthy_recordings, of_machines, outcome
from features.baselines.predictions import UNSURE
from gen.corpus.fault_classes import HEALTHY


def answer(fault, verdict, condition=""):
    return Answered("A", ALONE, condition, fault, verdict, {"inner": 0.5, HEALTHY: 0.25, "outer": 0.25})


@pytest.fixture
def file(tmp_path):
    """Two conditions at two speeds and two loads, with three axes of 0.1 s."""
    conditions, rpm, load = zip(*product(("sound", "bent shaft"), (600.0, 1200.0), (0.0, 11.0)), strict=True)
    acceleration = np.random.default_rng(0).standard_normal((8, 3, 2000))
    variables = {"acceleration": (("recording", "axis", "sample"), acceleration), "shaft_rpm": ("recording", list(rpm))}
    variables |= {"extra_load_lb": ("recording", list(load)), "condition": ("recording", list(conditions))}
    xr.Dataset(variables, attrs={"sample_rate_hz": 20_000.0}).to_netcdf(tmp_path / "healthy.nc")
    return tmp_path / "healthy.nc"


def test_every_recording_is_answered_alone_and_with_so_many_others_of_each_kind(file, monkeypatch):
    given = []

    class Found:
        verdict, probabilities = HEALTHY, {HEALTHY: 1.0}

    def diagnose(recorded, _given, _model, healthy=()):
        given.append((recorded.name, [one.name for one in healthy]))
        return Found

    monkeypatch.setattr(alarms, "diagnose_recording", diagnose)
    rows = counted(of_machines("A", healthy_recordings(file, "x"), None, 2))  # type: ignore[arg-type]
    assert {row["reference"]: row["answers"] for row in rows if row["condition"] == ALL} == {
        ALONE: 8,
        "same condition, same speed": 8,  # the other load alone
        "same condition, other speed": 16,
        "other condition, same speed": 16,
        "other condition, other speed": 16,
    }
    assert [row["answers"] for row in rows if row["condition"] in ("sound", "bent shaft")] == [4, 4]
    assert all(name not in references for name, references in given)


def test_an_outcome_is_right_unsure_a_miss_another_fault_or_an_alarm_and_other_verdicts_keep_their_name():
    pairs = [("inner", "inner"), ("inner", UNSURE), ("inner", HEALTHY), ("inner", "outer"), (HEALTHY, "outer")]
    assert tuple(outcome(answer(*pair)) for pair in pairs) == OUTCOMES
    assert outcome(answer("inner", "worn out")) == "worn out"
    assert outcome(answer(HEALTHY, "worn out")) == "alarm"
