"""The benchmark of colour: every recording is compared with another healthy one, and a change of gain is none."""

import numpy as np
import pytest

from benchmarks.colour import distances
from features import feature_table
from features.baselines.colour_distance import COUNTED
from features.baselines.records import feature_rows


def test_recordings_are_compared_with_another_healthy_one(tiny_corpus):
    found = distances(tiny_corpus)
    assert {fault: len(values) for fault, values in found.items()} == {
        "healthy": 12, "inner": 12, "outer": 12, "ball": 12
    }  # fmt: skip
    assert min(map(min, found.values())) > 0


def test_a_gain_changes_no_distance(tiny_corpus, monkeypatch):
    table = feature_table(tiny_corpus, ("bands",))
    gain = np.random.default_rng(0).uniform(-3, 3, table.sizes["record"])
    before = distances(tiny_corpus)
    louder = table.assign(features=table["features"] + gain[:, None])
    assert np.ptp(feature_rows(louder, COUNTED).to_numpy() - feature_rows(table, COUNTED).to_numpy()) > 1
    monkeypatch.setattr("benchmarks.colour.feature_table", lambda *_: louder)
    after = distances(tiny_corpus)
    assert {fault: pytest.approx(values) for fault, values in before.items()} == after
