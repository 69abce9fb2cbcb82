"""The kernel computes the same motion as its NumPy twin, mechanism by mechanism; see :mod:`tests.reference`; statistics of its motion."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.bearing import slipping_orders
from gen.physics.extent import MAX_BALLS
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate
from gen.physics.kernel.layout import N_DYNAMIC
from gen.physics.kernel_input import Turning, at_rest
from tests.lanes import march_lanes
from tests.reference import contact_stiffness, contacts, march_twin, right_hand_side
from tests.reference_motion import slow_motion, turned
from tests.strategies import RIG, extended_records, record, steady_records, troubled_records, wandering_records

law = settings(max_examples=10)
KNOT = 1 / 12_000
BALLS = st.integers(3, 24) | st.integers(25, MAX_BALLS)


def assert_the_twin_agrees(drawn, n_knots=8):
    lanes = march_lanes([drawn], n_knots, 4, KNOT)[0]
    twin = march_twin(drawn, lanes.states[0], n_knots, 4, KNOT)
    static = math.hypot(drawn.machine.load_x, drawn.machine.load_y) / drawn.machine.shaft_mass
    largest = max(np.abs(twin.accelerations).max(), 1e-3 * static)  # at rest the difference is rounding only
    np.testing.assert_allclose(lanes.angles, twin.angles, rtol=0, atol=1e-12)
    np.testing.assert_allclose(lanes.directions, twin.directions, rtol=0, atol=1e-12)
    np.testing.assert_allclose(lanes.states[:, :6], twin.states[:, :6], rtol=0, atol=1e-16)
    np.testing.assert_allclose(lanes.accelerations, twin.accelerations, rtol=0, atol=1e-9 * largest)


@law
@given(steady_records(balls=BALLS))
def test_the_kernel_goes_where_its_twin_goes_without_a_fault(drawn):
    assert_the_twin_agrees(drawn)


@law
@given(wandering_records(balls=BALLS))
def test_the_kernel_goes_where_its_twin_goes_with_spalls_and_wander(drawn):
    assert_the_twin_agrees(drawn)


@law
@given(extended_records())
def test_a_spall_under_several_balls_lets_each_of_them_drop(drawn):
    assert_the_twin_agrees(drawn)


@law
@given(troubled_records(balls=BALLS))
def test_the_kernel_goes_where_its_twin_goes_with_rollers_and_every_fault_of_bearing_and_machine(drawn):
    assert_the_twin_agrees(drawn, 12)


def assert_what_comes_out_is_the_twins(drawn, seed, slack):
    """Integrate 32 knots of a single step, as many as the integrator takes at once, and compare every one.

    The output is in single precision. The force rises steeply at first contact: squeezes may differ by ``slack`` [m].
    """
    pickups = np.random.default_rng(seed).normal(size=(2, 6))
    (drawn,) = at_rest([drawn._replace(pickups=pickups)])
    shape = input_shape(drawn)
    knot, n_knots = KNOT / 4, 32
    integral = integrate(shape, lay_out([drawn], shape, knot), knot, 1, decimation(1), 0, n_knots)
    start = lay_out([drawn], shape, knot).state.reshape(-1, LANES)[:N_DYNAMIC, 0]
    slow = slow_motion(drawn, knot, n_knots)
    states = march_twin(drawn, start, n_knots, 1, knot).states[:-1]
    if drawn.displacement:
        expected = states[:, :6] @ pickups.T
    else:
        rates = [right_hand_side(drawn, slow, knot, at, 0.0, y) for at, y in enumerate(states)]
        expected = np.array(rates)[:, 6:] @ pickups.T
    largest = np.abs(expected).max()
    np.testing.assert_allclose(
        integral.response[..., 0].T, expected, rtol=np.finfo(np.float32).eps, atol=1e-9 * largest
    )
    squeezes = [contacts(drawn, slow, at, 0.0, y).squeeze for at, y in enumerate(states)]
    low, high = (max(contact_stiffness(drawn.machine, s + off) for s in squeezes) for off in (-slack, slack))
    assert low * (1 - 1e-9) <= integral.steepest[0] <= high * (1 + 1e-9)
    assert (integral.diverged == -1).all()


@law
@given(wandering_records(balls=BALLS), st.integers(0, 2**32 - 1))
def test_the_integrator_gives_the_weighted_accelerations_and_the_largest_contact_stiffness(drawn, seed):
    assert_what_comes_out_is_the_twins(drawn, seed, 1e-20)


@law
@given(troubled_records(balls=BALLS), st.integers(0, 2**32 - 1))
def test_the_integrator_gives_the_weighted_displacements_and_the_largest_stiffness_of_rollers(drawn, seed):
    assert_what_comes_out_is_the_twins(drawn._replace(displacement=True), seed, 1e-11)


@settings(max_examples=3)
@given(wandering_records())
def test_angles_and_directions_are_still_exact_after_ten_thousand_knots(drawn):
    trip = march_lanes([drawn], 10_000, 1, KNOT)[0]
    exact = turned(drawn, KNOT, 10_000)[0]
    np.testing.assert_allclose(trip.angles, exact, rtol=0, atol=1e-9)
    cage, shaft = exact[:, 1], exact[:, 0]
    directions = np.stack([np.cos(cage), np.sin(cage), np.cos(shaft), np.sin(shaft)], axis=1)
    np.testing.assert_allclose(trip.directions, directions, rtol=0, atol=1e-9)


def test_the_distances_between_successive_balls_at_the_outer_race_are_independent_and_as_scattered_as_drawn():
    """The angle of the cage walks at random: its variance grows in proportion to time, from one ball to many."""
    seats, n_knots, walk = 16, 9600, 0.02
    drawn = [record(RIG, Turning(50.0, walk=walk, walk_seed=seed)) for seed in range(seats)]
    cages = np.array([trip.angles[:, 1] for trip in march_lanes(drawn, n_knots, 1, KNOT)])
    mean = 2 * np.pi * 50.0 * slipping_orders(drawn[0].bearing, 0.0).ftf * KNOT
    apart, away = 2 * np.pi / 9, cages - mean * np.arange(n_knots + 1)
    for balls in (1, 4):
        knots = round(balls * apart / mean)
        steps = np.diff(away[:, ::knots], axis=1)
        # 16 lanes of 35 or 143 passages: the standard deviation has a standard error of at most 3 %
        assert steps.std() == pytest.approx(walk * apart * np.sqrt(balls), rel=0.1)
        follower = np.corrcoef(steps[:, :-1].ravel(), steps[:, 1:].ravel())[0, 1]
        assert abs(follower) < 0.15
