"""Past defects that no other test detects."""

import json

import numpy as np
import pytest

import gen
from gen import CorpusError, RecipeError, draw_scenarios, generate
from gen.scenarios import settings_of
from gen.simulation.inputs import kernel_input
from gen.simulation.simulate import simulate
from gen.simulation.timeline import timeline


def test_a_record_does_not_depend_on_whether_its_neighbours_have_waviness(recipe_with):
    recipe = recipe_with(
        {
            "faults": [{"kind": "inner", "width_mm": 0.5}],
            "specimen.waviness_nm": "choice(0, 500)",
        }
    )
    scenarios = draw_scenarios(recipe)
    assert (
        len({kernel_input(scenario, timeline(settings_of(recipe))).waviness.races.size for scenario in scenarios}) == 2
    )
    together = simulate(scenarios).acceleration
    for place in (0, len(scenarios) - 1):
        np.testing.assert_array_equal(simulate(scenarios[place : place + 1]).acceleration[0], together[place])


def test_a_folder_with_somebody_elses_manifest_is_left_alone(tmp_path):
    (tmp_path / "manifest.json").write_text(json.dumps({"name": "an app"}))
    (tmp_path / "README.md").write_text("mine")
    with pytest.raises(CorpusError, match=r"manifest\.json"):
        generate("quickstart", tmp_path, records=8)
    assert (tmp_path / "README.md").read_text() == "mine"


def test_a_path_that_lets_nothing_through_is_refused(recipe_with):
    with pytest.raises(RecipeError, match=r"path\.direct: 0 without modes"):
        recipe_with({"path": {"direct": 0}})


def test_a_grid_goes_on_from_specimen_to_specimen(recipe_with):
    speeds = [600, 900, 1200, 1500]
    recipe = recipe_with({"operation.shaft_rpm": gen.grid(*speeds)})
    found = [60 * scenario.record.conditions.shaft_rate for scenario in draw_scenarios(recipe)]
    assert found == pytest.approx([speeds[number % 4] for number in range(len(found))])


def test_two_rigs_are_enough_to_set_one_aside(recipe_with):
    split = {"by": "rig", "test": 0.2, "validation": 0}
    recipe = recipe_with({"corpus.rigs": 2, "corpus.split": split})
    by_rig = {scenario.rig.number: scenario.specimen.split for scenario in draw_scenarios(recipe)}
    assert sorted(by_rig.values()) == ["test", "train"]
