"""The sizes that `raceway.limit` tells from 400 records are those of thousands: intervals against the truth of the twin."""

import pytest

import raceway
from features import feature_table
from gen import generate
from gen.recipe import Recipe
from tests.conftest import small_with
from tests.raceway.visibility.test_limit import TWIN_SEES
from tests.recipes import LADDER


def test_the_intervals_of_ladders_of_400_records_hold_the_widths_that_2000_others_show(tmp_path):
    rigs = {"corpus": LADDER["corpus"] | {"rigs": 500}}
    corpus = generate(Recipe(small_with(LADDER | rigs)), tmp_path / "ladders", workers=2).path
    table = feature_table(corpus)
    truth = _twin(table.isel(record=range(2000, 4000)))
    for name, size in TWIN_SEES.items():
        assert getattr(truth, name)[0] == pytest.approx(size, rel=0.01)
    held = []
    for first in range(0, 2000, 400):
        ladder = _twin(table.isel(record=range(first, first + 400)))
        held += [low <= size <= high for name, size in TWIN_SEES.items() for _, low, high in [getattr(ladder, name)]]
    # 95 % of 10, less three standard deviations
    assert sum(held) >= 8


def _twin(table):
    twin, _ = raceway.limit(table, estimator="logistic_regression")
    return twin
