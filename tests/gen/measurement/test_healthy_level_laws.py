"""Balls of a healthy bearing pass the load at BPFO: from which level on that line stands out, as the page of recipes says."""

import numpy as np
import pytest

import gen
from features import feature_table
from gen.recipe import Recipe

RECIPE = {
    "name": "healthy", "title": "Healthy bearings", "seed": 1,
    "corpus": {"rigs": 6, "specimens_per_rig": 2, "records_per_specimen": 2},
    "storage": {"records_per_part": 24}, "recording": {"sample_rate_hz": 12_000, "duration_s": 0.5, "settle_s": 0.1}, "bearing": "6206",
    "operation": {"shaft_rpm": "uniform(1400, 1800)", "load_n": 700}, "faults": [{"kind": "healthy"}],
}  # fmt: skip


@pytest.mark.parametrize(("waviness_nm", "hidden_db", "seen_db"), [(0, -10, 0), (20, 0, 10)])
def test_a_healthy_bearing_shows_bpfo_above_the_ratio_that_the_page_names(waviness_nm, hidden_db, seen_db):
    combs = []
    for ratio in (hidden_db, seen_db):
        level = {"kind": "snr", "faulty_db": 0, "healthy_db": ratio}
        recipe = Recipe.model_validate(RECIPE | {"specimen": {"waviness_nm": waviness_nm}, "level": level})
        table = feature_table(gen.simulate([*gen.draw_scenarios(recipe)]), ("lines",))
        place = list(table["feature"].values).index("whitened_bpfo_comb")
        combs.append(np.median(table["features"].values[:, place]))
    # in white noise, fewer than one record in a hundred has a comb above 1.0
    assert combs[0] < 0.6 < 1.0 < combs[1]
