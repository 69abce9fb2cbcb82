"""Static rest of the model study: 300 N on a 6205 with a ball at the bottom."""

import json

import numpy as np
import pytest

from gen.physics.rotor import Machine, as_columns, ball_forces, rest
from tests.paths import GOLDEN

CASE = json.loads((GOLDEN / "model.json").read_text())["static_rest"]


def test_the_shaft_rests_as_deep_and_its_lowest_ball_bears_as_much_as_in_the_model_study():
    fields = dict.fromkeys(Machine._fields, 0.0) | {
        "load_deflection_factor": CASE["load_deflection_factor"],
        "half_clearance": CASE["half_clearance"],
        "support_stiffness_x": CASE["support_stiffness"],
        "support_stiffness_y": CASE["support_stiffness"],
        "contact_cosine": 1.0,
        "contact_exponent": 1.5,
        "load_y": -CASE["load"],
    }
    machine = as_columns([Machine(**fields)])
    places = -np.pi / 2 + 2 * np.pi * np.arange(9)[None] / 9
    q = rest(machine, places)
    relative = q[:, :2] - q[:, 2:]
    assert -relative[0, 1] == pytest.approx(CASE["relative_displacement"], rel=5e-3)
    assert ball_forces(machine, relative, places)[0].max() == pytest.approx(CASE["largest_ball_force"], rel=5e-3)
    assert q[0, 3] == pytest.approx(-CASE["load"] / CASE["support_stiffness"], rel=1e-9)
