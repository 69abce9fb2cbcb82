"""Laws of the angle of the shaft: it is the angle by which the bearing turns."""

import numpy as np
import pytest

from gen import open_corpus, shaft_angles
from gen.scenarios import draw_scenarios, read_scenarios
from gen.simulation.motion import draw_motion
from gen.simulation.shaft import angles_of
from gen.simulation.timeline import timeline
from gen.support.errors import CorpusError
from tests.reference_motion import turned
from tests.responses import input_of

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
    axis = timeline(recipe)
    for scenario in draw_scenarios(recipe, 0, 4):
        in_kernel = turned(input_of(scenario), 1 / axis.fs, axis.knots)[0][:, 0]
        in_kernel = in_kernel[axis.dropped : axis.dropped + axis.returned]
        # the kernel takes the wander as linear between every eighth knot
        np.testing.assert_allclose(angles_of(draw_motion(scenario)), in_kernel, rtol=0, atol=2e-5)


def test_records_of_a_corpus_have_the_angle_of_their_scenarios_and_imported_ones_that_of_their_label(tiny_corpus):
    with open_corpus(tiny_corpus) as corpus:
        some = corpus.isel(record=[3, 17]).load()
    axis = timeline(read_scenarios(some)[0].recipe)
    angles = shaft_angles(some)
    assert angles.dims == ("record", "elapsed_time")
    for angle, scenario in zip(angles.values, read_scenarios(some), strict=True):
        np.testing.assert_array_equal(angle, angles_of(draw_motion(scenario))[axis.kept])
    np.testing.assert_array_equal(shaft_angles(some.isel(record=1)), angles[1])
    imported = some.drop_vars("draws")
    turns = shaft_angles(imported) / (2 * np.pi)
    np.testing.assert_allclose(turns, imported.shaft_rate * imported.elapsed_time, atol=1e-9)
    with pytest.raises(CorpusError, match="record 1 has no shaft rate"):
        shaft_angles(imported.assign(shaft_rate=imported.shaft_rate * [1, np.nan]))
    with pytest.raises(CorpusError, match="record 0 has no scenario"):
        shaft_angles(some.assign(draws=("record", ["", ""])))
