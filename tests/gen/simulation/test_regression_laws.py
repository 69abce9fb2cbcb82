"""Past defects that no other test detects."""

import numpy as np

from gen import draw_scenarios
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


def test_two_rigs_are_enough_to_set_one_aside(recipe_with):
    split = {"by": "rig", "test": 0.2, "validation": 0}
    recipe = recipe_with({"corpus.rigs": 2, "corpus.split": split})
    by_rig = {scenario.origin.rig: scenario.origin.split for scenario in draw_scenarios(recipe)}
    assert sorted(by_rig.values()) == ["test", "train"]
