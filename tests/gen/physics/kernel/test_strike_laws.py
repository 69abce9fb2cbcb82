"""Laws of the force of a ball that strikes the edge of a spall."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.impact import edge_strikes, hertz_time, rolling_mass
from gen.physics.inputs import SpallInput, Turning
from gen.physics.kernel.pulse import pushed
from tests.lanes import march_lanes
from tests.reference import march_twin
from tests.strategies import RIG, record

law = settings(deadline=None, max_examples=100)
KNOT = 1 / 12_000
BEARING = CATALOGUE["6205"]
BALL, MASS = BEARING.ball_diameter / 2, rolling_mass(BEARING)
# next to nothing but load and contacts acts on the two rings, so that the sum of their momenta changes by outer forces alone
FREE = RIG._replace(
    sensor_stiffness_x=0.0, sensor_stiffness_y=0.0, sensor_damping=0.0, ring_damping=0.0,
    shaft_damping=0.0, support_stiffness_x=1.0, support_stiffness_y=1.0,
    support_damping_x=0.0, support_damping_y=0.0, contact_damping=100.0, load_x=0.0,
)  # fmt: skip
RACES = {"inner": BEARING.inner_radius, "outer": -BEARING.outer_radius}
RATE = 30.0


def mean_force(since, length, step):
    """Mean under a hat of a half sine of unit momentum [1/s]."""
    difference = sum(part * pushed.py_func(since + k * step, length) for k, part in ((-1, 1), (0, -2), (1, 1)))
    return math.pi / (2 * length * step**2) * difference


@law
@given(st.floats(1e-6, 3e-4), st.floats(1e-6, 5e-5), st.floats(0, 1))
def test_a_pulse_has_its_momentum_at_any_step_however_short_it_is(length, step, share):
    """Simpson's rule, which a Runge-Kutta step is for a force of time alone, over nodes at half steps."""
    times = np.arange(-4, 2 * math.ceil(length / step) + 7) * step / 2 + share * step
    values = np.array([mean_force(since, length, step) for since in times])
    steps = values[:-2:2] + 4 * values[1:-1:2] + values[2::2]
    assert (values >= -1e-9 / length).all()
    assert step / 6 * steps.sum() == pytest.approx(1.0, rel=1e-6)


def struck(site, width=0.5e-3, depth=1.0, *, ball=0.0, late=0.0):
    """A record whose ball 0, under the load, soon strikes the spall, with strikes of a ball of the given mass."""
    arc = BEARING.radius(site)
    races = tuple(RACES.values()) if site == "ball" else (RACES[site],)
    strikes = tuple(edge_strikes(width, arc, BALL, race, depth) for race in races)
    turning = Turning(RATE, jitter_rms=1e-12, cage_angle=-math.pi / 2, shaft_angle=0.0, spin_angle=0.0)
    # the shaft runs ahead of the cage: an inner spall comes from behind the ball
    angle = {"outer": -math.pi / 2 + 0.01, "inner": -math.pi / 2 - 0.01, "ball": -0.03}[site] + late
    spall = SpallInput(site, width, depth, angle, strikes=strikes)
    return record(FREE, turning, [spall], waviness=1e-12)._replace(ball_mass=ball, hertz_time=hertz_time(BEARING))


def held(squeeze):
    """State in which the shaft is displaced along the load by so much more than half the clearance."""
    start = np.zeros(12)
    start[1] = -(FREE.half_clearance + squeeze)
    return start


def momenta(drawn, squeeze, n_knots=60):
    """Momentum of shaft and of housing together at the knots, shape (knot, axis) [N s]."""
    states = march_lanes([drawn], n_knots, 4, KNOT, held(squeeze))[0].states
    return FREE.shaft_mass * states[:, 6:8] + FREE.housing_mass * states[:, 8:10]


@pytest.mark.parametrize(("site", "side"), [("outer", -1), ("inner", 1)])
def test_one_passage_gives_the_race_the_momentum_of_the_ball(site, side):
    """Mass times change of slope times speed of the contact along the race, outwards from an outer and inwards from an inner race."""
    speed = 2 * math.pi * RATE * 0.5 * (1 - BEARING.gamma**2) * BEARING.pitch_diameter / 2  # of rolling, on both races
    drawn = struck(site, ball=1e-9)  # too light to change the motion of the rings
    given = momenta(drawn, 60e-6) - momenta(drawn._replace(ball_mass=0.0), 60e-6)
    (strike,) = drawn.spalls[0].strikes[0]
    assert given[0] == pytest.approx(0.0, abs=1e-25)
    assert math.hypot(*given[-1]) == pytest.approx(1e-9 * strike.change * speed, rel=1e-3)
    assert given[-1][1] * side > 0


def test_a_ball_that_the_races_do_not_hold_strikes_nothing():
    drawn = struck("outer", ball=MASS)
    heavy, light = (momenta(some, -4e-6, 30) for some in (drawn, drawn._replace(ball_mass=0.0)))
    np.testing.assert_array_equal(heavy, light)


@pytest.mark.parametrize("site", ["outer", "inner", "ball"])
@pytest.mark.parametrize("depth", [1.0, 2e-6], ids=["bridged", "with a floor"])
def test_the_twin_strikes_alike(site, depth):
    drawn = struck(site, depth=depth, ball=MASS)
    start, n_knots = held(20e-6), 40
    lanes = march_lanes([drawn], n_knots, 4, KNOT, start)[0]
    twin = march_twin(drawn, start, n_knots, 4, KNOT)
    without = march_lanes([drawn._replace(ball_mass=0.0)], n_knots, 4, KNOT, start)[0]
    largest = np.abs(twin.accelerations).max()
    np.testing.assert_allclose(lanes.accelerations, twin.accelerations, rtol=0, atol=1e-7 * largest)
    assert np.abs(lanes.accelerations - without.accelerations).max() > 1e-3 * largest
