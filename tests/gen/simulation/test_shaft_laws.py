"""Laws of the angle of the shaft: it is the angle by which the bearing turns."""

import numpy as np
import pytest

from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.inputs import kernel_input
from gen.simulation.shaft import shaft_angles
from gen.simulation.timeline import timeline
from tests.reference import slow_motion
from tests.responses import truth

COURSES = {
    "constant": {"operation.speed_wander_percent": 0},
    "wandering": {"operation.speed_wander_percent": 2},
    "ramp": {"operation.speed_profile": {"kind": "ramp", "from_percent": 50, "to_percent": 150}},
    "run-up": {"operation.speed_profile": {"kind": "run_up", "from_percent": 20, "to_percent": 120, "lasting_s": 0.08}},
    "steps": {"operation.speed_profile": {"kind": "steps", "levels_percent": [60, 100, 80], "step_s": 0.01}},
    "table": {"operation.speed_profile": {"kind": "table", "times_s": [0, 0.03, 0.1], "percent": [100, 40, 90]}},
    "ramp that wanders": {
        "operation.speed_wander_percent": 2,
        "operation.speed_profile": {"kind": "ramp", "from_percent": 50, "to_percent": 150},
    },
}
courses = pytest.mark.parametrize("changes", COURSES.values(), ids=COURSES)


@courses
def test_the_angle_is_that_by_which_the_kernel_turns_the_bearing(recipe_with, changes):
    recipe = recipe_with({"recording.settle_s": 0.2} | changes)
    axis = timeline(settings_of(recipe))
    for scenario in draw_scenarios(recipe, 0, 4):
        in_kernel = slow_motion(kernel_input(scenario, axis), 1 / axis.fs, axis.knots).angles[:, 0]
        in_kernel = in_kernel[axis.dropped : axis.dropped + axis.returned]
        # the kernel takes the wander as linear between every eighth knot
        np.testing.assert_allclose(shaft_angles(scenario, axis), in_kernel, rtol=0, atol=2e-5)


@courses
def test_the_turns_of_a_record_are_its_labelled_mean_rate_times_its_duration(recipe_with, changes):
    recipe = recipe_with({"recording.settle_s": 0.2} | changes)
    axis = timeline(settings_of(recipe))
    for scenario in draw_scenarios(recipe, 0, 4):
        angles = shaft_angles(scenario, axis)[axis.kept]
        turns = (angles[-1] - angles[0]) / (2 * np.pi) * len(angles) / (len(angles) - 1)
        assert turns == pytest.approx(truth(scenario, recipe).true_shaft_rate * axis.duration, rel=2e-3)
