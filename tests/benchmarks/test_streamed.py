"""The benchmark of the stream, on short records: its folder goes on where it ended, and what it teaches is tested."""

import numpy as np

from benchmarks import streamed
from gen.recipe import Recipe
from tests.conftest import small_with


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
