"""Laws of an axial load: it is in balance with the radial load on the same balls, and compresses them more if it is larger."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import root

from gen.physics.axial import HALF_LOADED, axial_approach, check_axial_load
from gen.physics.hertz import LINE_EXPONENT
from gen.physics.rotor import as_columns, ball_angles
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from tests.responses import failures_of
from tests.strategies import RIG

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


def approach_of(machine, axial, places):
    """Approach of one record whose axial load is allowed [m]."""
    check_axial_load(machine, axial)
    return axial_approach(as_columns([machine]), np.array([axial]), places[None])[0]


def ball_forces(machine, approach, displacement, angles):
    """Along the lines of contact, shape (ball,) [N]."""
    out = displacement[0] * np.cos(angles) + displacement[1] * np.sin(angles)
    squeeze = machine.contact_cosine * out + approach - machine.half_clearance
    return machine.load_deflection_factor * np.maximum(squeeze, 0.0) ** machine.contact_exponent


@given(slants, clearances, rolling, places, st.floats(10, 3000), st.floats(-math.pi, math.pi), st.floats(1.05, 20))
def test_balls_squeezed_by_the_approach_carry_radial_and_axial_load_at_once(
    angle, clearance, rolling, places, load, direction, times
):
    """A root finder that uses no energy solves the radial balance again; the axial sum of the forces is then the axial load."""
    machine = slanted(angle, clearance, rolling, load, direction)
    axial = times * HALF_LOADED * load * math.tan(angle)
    approach = approach_of(machine, axial, places)
    towards = np.array([math.cos(direction), math.sin(direction)])

    def unbalanced(micrometres):
        force = machine.contact_cosine * ball_forces(machine, approach, micrometres * 1e-6, places)
        return (force @ np.stack([np.cos(places), np.sin(places)], axis=1) - load * towards) / load

    solution = root(unbalanced, towards)
    assert solution.success
    forces = ball_forces(machine, approach, solution.x * 1e-6, places)
    assert math.sin(angle) * forces.sum() == pytest.approx(axial, rel=1e-4)


@given(slants, clearances, rolling, places, st.floats(1, 1e4))
def test_without_a_radial_load_all_balls_share_the_axial_one(angle, clearance, rolling, places, axial):
    factor, exponent = rolling
    each = (axial / (N_BALLS * math.sin(angle) * factor)) ** (1 / exponent)
    approach = approach_of(slanted(angle, clearance, rolling), axial, places)
    assert approach == pytest.approx(each + clearance, rel=1e-5, abs=1e-11)


@given(
    st.lists(
        st.tuples(slants, clearances, st.integers(5, 20), st.floats(10, 3000), st.floats(1.05, 20)),
        min_size=2,
        max_size=9,
    ),
    rolling,
)
def test_the_approach_of_a_record_does_not_depend_on_the_others(drawn, rolling):
    machines = [slanted(angle, clearance, rolling, load, angle) for angle, clearance, _, load, _ in drawn]
    axial = np.array([times * HALF_LOADED * load * math.tan(angle) for angle, _, _, load, times in drawn])
    balls = ball_angles([n_balls for _, _, n_balls, _, _ in drawn], [angle for angle, *_ in drawn])
    together = axial_approach(as_columns(machines), axial, balls)
    for place, (_, _, n_balls, _, _) in enumerate(drawn):
        alone = axial_approach(as_columns(machines[place : place + 1]), axial[[place]], balls[[place], :n_balls])
        assert alone == together[place : place + 1]


@pytest.mark.parametrize("angle", [math.radians(10), math.radians(40)])
def test_rings_that_an_axial_load_cannot_hold_together_are_refused(angle):
    machine = slanted(angle, 5e-6, (9.26e9, 1.5), 300.0)
    least = 1.25 * 300 * math.tan(angle)
    places = 2 * np.pi * np.arange(N_BALLS) / N_BALLS
    with pytest.raises(ValueError, match="is too small to hold its rings together; give at least") as refused:
        approach_of(machine, 0.99 * least, places)
    asked = float(re.search(r"at least (\S+) N\.$", str(refused.value))[1])
    assert asked == pytest.approx(least, rel=1e-3)
    assert approach_of(machine, asked, places) > 0


def test_the_axial_load_holds_against_the_heaviest_radial_load_of_a_profile(recipe_with):
    profile = {"kind": "ramp", "from_percent": 100, "to_percent": 300}
    changes = {"specimen.contact_angle_deg": 15, "operation.load_n": 300, "operation.axial_load_n": 200}
    for load_profile, held in ((None, True), (profile, False)):
        recipe = recipe_with(changes | {"operation.load_profile": load_profile})
        failures = failures_of(simulate(draw_scenarios(recipe, 0, 1)))
        assert (failures == {}) == held
