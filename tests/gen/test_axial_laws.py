"""Laws of an axial load: it balances with the radial one on the same balls, and squeezes them more the larger it is."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import root

from gen.errors import SimulationError
from gen.generate import generate
from gen.physics.axial import HALF_LOADED, axial_approach
from gen.physics.hertz import LINE_EXPONENT
from gen.plan import plan
from tests.strategies import RIG

law = settings(deadline=None, max_examples=40)
N_BALLS = 9
slants = st.floats(math.radians(5), math.radians(40))
clearances = st.floats(-5e-6, 20e-6)
places = st.floats(0, 2 * math.pi / N_BALLS).map(lambda first: first + 2 * np.pi * np.arange(N_BALLS) / N_BALLS)
rolling = st.sampled_from([(9.26e9, 1.5), (1.3e9, LINE_EXPONENT)])


def slanted(angle, half_clearance, rolling, load=0.0, direction=0.0):
    return RIG._replace(
        contact_cosine=math.cos(angle), half_clearance=half_clearance, load_deflection_factor=rolling[0],
        contact_exponent=rolling[1], load_x=load * math.cos(direction), load_y=load * math.sin(direction),
    )  # fmt: skip


def ball_forces(machine, approach, displacement, angles):
    """Along the lines of contact, shape (ball,) [N]."""
    out = displacement[0] * np.cos(angles) + displacement[1] * np.sin(angles)
    squeeze = machine.contact_cosine * out + approach - machine.half_clearance
    return machine.load_deflection_factor * np.maximum(squeeze, 0.0) ** machine.contact_exponent


@law
@given(slants, clearances, rolling, places, st.floats(10, 3000), st.floats(-math.pi, math.pi), st.floats(1.05, 20))
def test_balls_squeezed_by_the_approach_carry_radial_and_axial_load_at_once(
    angle, clearance, rolling, places, load, direction, times
):
    """The radial balance is found again, by a root finder that knows no energy; what then points along the axis is the axial load."""
    machine = slanted(angle, clearance, rolling, load, direction)
    axial = times * HALF_LOADED * load * math.tan(angle)
    approach = axial_approach(machine, axial, places)
    towards = np.array([math.cos(direction), math.sin(direction)])

    def unbalanced(micrometres):
        force = machine.contact_cosine * ball_forces(machine, approach, micrometres * 1e-6, places)
        return (force @ np.stack([np.cos(places), np.sin(places)], axis=1) - load * towards) / load

    found = root(unbalanced, towards)
    assert found.success
    forces = ball_forces(machine, approach, found.x * 1e-6, places)
    assert math.sin(angle) * forces.sum() == pytest.approx(axial, rel=1e-4)


@law
@given(slants, clearances, rolling, places, st.floats(1, 1e4))
def test_without_a_radial_load_all_balls_share_the_axial_one(angle, clearance, rolling, places, axial):
    factor, exponent = rolling
    each = (axial / (N_BALLS * math.sin(angle) * factor)) ** (1 / exponent)
    found = axial_approach(slanted(angle, clearance, rolling), axial, places)
    assert found == pytest.approx(each + clearance, rel=1e-5, abs=1e-11)


@law
@given(slants, clearances, rolling, places, st.floats(10, 1000), st.floats(1.05, 10), st.floats(1.01, 5))
def test_more_axial_load_squeezes_more(angle, clearance, rolling, places, load, times, more):
    machine = slanted(angle, clearance, rolling, load)
    axial = times * HALF_LOADED * load * math.tan(angle)
    assert axial_approach(machine, more * axial, places) > axial_approach(machine, axial, places)


@pytest.mark.parametrize("angle", [math.radians(10), math.radians(40)])
def test_rings_that_an_axial_load_cannot_hold_together_are_refused(angle):
    machine = slanted(angle, 5e-6, (9.26e9, 1.5), 300.0)
    least = 1.25 * 300 * math.tan(angle)
    places = 2 * np.pi * np.arange(N_BALLS) / N_BALLS
    with pytest.raises(ValueError, match=rf"is too small to hold its rings together; at least {least:.3g} N do\."):
        axial_approach(machine, 0.99 * least, places)
    assert axial_approach(machine, 1.01 * least, places) > 0


def test_an_axial_load_needs_a_slanted_contact():
    machine = slanted(0.0, 5e-6, (9.26e9, 1.5), 300.0)
    with pytest.raises(ValueError, match=r"an axial load of 500 N needs a contact angle above 0\."):
        axial_approach(machine, 500.0, np.zeros(1))


@pytest.mark.parametrize("command", ["plan", "generate"])
@pytest.mark.parametrize(
    ("angle", "reason"),
    [
        (0, r"an axial load of 50 N needs a contact angle above 0\."),
        (15, r"an axial load of 50 N is too small to hold its rings together; at least 100 N do\."),
    ],
)
def test_a_recipe_whose_axial_load_cannot_be_carried_names_the_record(write_recipe, tmp_path, command, angle, reason):
    """Every second record has it; 300 N times 1.25 tan 15 degrees are 100 N."""
    changes = {
        "specimen.contact_angle_deg": angle,
        "operation.load_n": 300,
        "operation.axial_load_n": {"kind": "grid", "values": [0, 50]},
    }
    recipe = write_recipe(tmp_path / "r.yaml", changes)
    with pytest.raises(SimulationError, match=rf"^record 1: {reason}$"):
        plan(recipe) if command == "plan" else generate(recipe, tmp_path / "c")
