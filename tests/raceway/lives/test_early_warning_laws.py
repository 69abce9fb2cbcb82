"""Laws of early warning: the rate of false alarms that was asked for, delays that the feature allows, and bearings that are missed."""

import numpy as np
import pytest
import xarray as xr

from gen.corpus import FAULTS
from gen.support.errors import CorpusError
from raceway.lives.early_warning import warn_early

HOUR = 3600.0
BEGUN, SEEN, END = 400, 450, 600  # h, one snapshot each


def table(seed, rises_at=SEEN, bearings=30):
    """Lives in which ``raw_kurtosis`` jumps at some hour, beside a feature that is noise; all spalls can be seen from the same hour on."""
    rng = np.random.default_rng(seed)
    age = np.tile(np.arange(END) * HOUR, bearings)
    hours, specimen = age / HOUR, np.repeat(np.arange(bearings), END)
    features = rng.standard_normal((len(age), 2))
    features[:, 0] += 20 * (hours >= rises_at)
    columns = {
        "age": age, "rul": (END - hours) * HOUR, "event": np.ones(len(age), int), "specimen": specimen,
        "stage": (hours >= BEGUN).astype(int),
        "fault": np.where(hours >= BEGUN, FAULTS.index("outer"), FAULTS.index("healthy")),
        "first_detectable_time": np.full(len(age), SEEN * HOUR),
    }  # fmt: skip
    return xr.Dataset(
        {"features": (("record", "feature"), features), "feature": ["raw_kurtosis", "noise"]}
        | {name: ("record", values) for name, values in columns.items()}
    ).isel(record=rng.permutation(len(age)))


@pytest.mark.parametrize("rate", [1.0, 20.0])
def test_other_bearings_give_the_false_alarms_that_were_asked_for(rate):
    warned = warn_early(
        table(0, bearings=60), table(1, bearings=60), alarms_per_1000_h=rate, estimator="logistic_regression"
    )
    expected = rate * 60 * BEGUN / 1000
    for found in warned.alarms_per_1000_h:
        assert found * 60 * BEGUN / 1000 == pytest.approx(expected, abs=5 * np.sqrt(2 * expected))


@pytest.mark.parametrize("late", [0, 30])
def test_the_delay_is_that_of_the_feature_beyond_the_first_snapshot_that_shows_it(late):
    warned = warn_early(table(2, SEEN + late), alarms_per_1000_h=0, estimator="logistic_regression")
    assert warned.delay["raw_kurtosis"] == late * HOUR
    assert warned.time_left["raw_kurtosis"] == pytest.approx(1 - late / (END - 1 - SEEN))
    assert warned.missed["raw_kurtosis"] == 0
    assert warned.delay["logistic_regression"] <= late * HOUR


def test_a_feature_that_never_rises_misses_every_bearing():
    warned = warn_early(table(3, END), alarms_per_1000_h=0, estimator="majority")
    assert warned.missed.min() > 0.9


def test_tables_that_do_not_know_what_can_be_seen_are_refused():
    with pytest.raises(CorpusError, match=r"early warning needs simulated lives with truth\.twins: true"):
        warn_early(table(4).drop_vars("first_detectable_time"))
