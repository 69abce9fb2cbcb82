"""The benchmarks of additions, colour, shaft speeds and the stream, on small corpora."""

import numpy as np

from benchmarks import streamed
from benchmarks.additions import ADDITIONS, tables
from benchmarks.colour import distances
from benchmarks.speed import recordings, report
from gen.corpus import FAULTS
from gen.recipe import Recipe
from tests.conftest import small_with
from tests.features.table.test_recording_speeds import SPEEDS, TRUTH, WINDOWS, write_machines
from tests.pulses import write_pulses

FAMILIES = ("outer", "inner", "ball")


def test_every_addition_but_noise_has_the_line_of_the_fault_on_top(tmp_path):
    made = tables(write_pulses(tmp_path / "pulses", duration=0.5))
    default = made.pop("default set")["features"].values
    faulty = np.flatnonzero(made["noise (control)"]["fault"].values != FAULTS.index("healthy"))
    assert set(made) == set(ADDITIONS)
    for addition, table in made.items():
        values = table["features"].values
        np.testing.assert_array_equal(values[:, : default.shape[1]], default)
        top = values[faulty, -3:].argmax(axis=1)
        own = [FAMILIES.index(FAULTS[code]) for code in table["fault"].values[faulty]]
        assert np.mean(top == own) > 0.9 or "noise" in addition


def test_recordings_are_compared_with_another_healthy_one(tiny_corpus):
    found = distances(tiny_corpus)
    assert {fault: len(values) for fault, values in found.items()} == {
        "healthy": 12, "inner": 12, "outer": 12, "ball": 12
    }  # fmt: skip
    assert min(map(min, found.values())) > 0


def test_the_table_has_a_row_per_class_and_known_speeds(tmp_path):
    corpus = write_machines(tmp_path / "machines", extra=(TRUTH,))
    for recording, (label, true) in zip(recordings(corpus), SPEEDS.values(), strict=True):
        assert (len(recording.x), recording.label, recording.true) == (WINDOWS, label, true)
    lines = list(report(corpus, "made"))
    assert [line.split(" | ")[1] for line in lines] == ["healthy", "inner", "outer", "ball"]
    assert {line.count("|") for line in lines} == {10}


def test_a_folder_goes_on_where_it_ended_and_teaches_an_ensemble(tmp_path, monkeypatch):
    monkeypatch.setattr(streamed, "RECIPE", Recipe(small_with({})))
    monkeypatch.setattr(streamed, "BATCH", 10)
    monkeypatch.setattr("features.baselines.estimators.TREES", 10)
    assert len(streamed.streamed(1, 15, tmp_path / "grown").levels) == 15
    grown, at_once = (streamed.streamed(1, 40, tmp_path / name) for name in ("grown", "at once"))
    np.testing.assert_array_equal(grown.levels, at_once.levels)
    assert grown.table["recording"].values.tolist() == list(range(40))
    assert grown.table.identical(at_once.table)
    window, recording = streamed.ensemble_scores(grown, 0, {"own": at_once})
    assert window == recording > 0.7
