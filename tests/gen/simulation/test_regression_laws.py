"""Past defects that no other test detects."""

import json

import numpy as np
import pytest

from gen import CorpusError, draw_scenarios, generate
from gen.simulation.simulate import simulate
from tests.responses import input_of


def test_a_record_does_not_depend_on_whether_its_neighbours_have_waviness(recipe_with):
    recipe = recipe_with({"faults": [{"kind": "inner", "width_mm": 0.5}], "specimen.waviness_nm": "choice(0, 500)"})
    scenarios = draw_scenarios(recipe)
    assert len({input_of(scenario).waviness.races.size for scenario in scenarios}) == 2
    together = simulate(scenarios)
    for place in (0, -1):
        (alone,) = simulate([scenarios[place]])
        np.testing.assert_array_equal(alone.acceleration, together[place].acceleration)


def test_a_folder_with_somebody_elses_manifest_is_left_alone(tmp_path):
    (tmp_path / "manifest.json").write_text(json.dumps({"name": "an app"}))
    (tmp_path / "README.md").write_text("mine")
    with pytest.raises(CorpusError, match=r"manifest\.json"):
        generate("quickstart", tmp_path, records=8)
    assert (tmp_path / "README.md").read_text() == "mine"


def test_two_rigs_are_enough_to_set_one_aside(recipe_with):
    split = {"by": "rig", "test": 0.2, "validation": 0}
    recipe = recipe_with({"corpus.rigs": 2, "corpus.split": split})
    by_rig = {scenario.origin.rig: scenario.origin.split for scenario in draw_scenarios(recipe)}
    assert sorted(by_rig.values()) == ["test", "train"]
