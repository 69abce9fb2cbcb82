"""Largest drops of a 6205 as the model study gives them, to its three figures."""

import json

import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.kernel.drop import GEOMETRIC, drop
from tests.paths import GOLDEN

DROPS = json.loads((GOLDEN / "model.json").read_text())["largest_drops_6205_um"]


@pytest.mark.parametrize("row", DROPS, ids=lambda row: f"{row['width_mm']}mm")
def test_the_largest_drop_is_the_one_of_the_model_study(row):
    bearing = CATALOGUE["6205"]
    for site, race in (("inner", bearing.inner_radius), ("outer", -bearing.outer_radius)):
        arc = abs(race)
        found = drop(GEOMETRIC, 0.0, row["width_mm"] * 1e-3 / 2 / arc, arc, bearing.ball_diameter / 2, race, 5e-3)
        assert found * 1e6 == pytest.approx(row[site], rel=5e-3)
