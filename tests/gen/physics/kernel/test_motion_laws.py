"""Laws of the motion of shaft, cage, balls and spalls between the knots."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.bearing import slipping_orders
from gen.physics.inputs import SpallInput, Turning
from gen.physics.kernel.layout import SPEED_TERMS
from tests.lanes import march_lanes
from tests.reference import process, slow_motion
from tests.strategies import RIG, angles, machines, record, seeds, wandering_records, wandering_turnings

law = settings(deadline=None, max_examples=15)
KNOT = 1 / 12_000


@settings(deadline=None, max_examples=3)
@given(wandering_records())
def test_angles_and_directions_are_still_exact_after_ten_thousand_knots(drawn):
    trip = march_lanes([drawn], 10_000, 1, KNOT)[0]
    exact = slow_motion(drawn, KNOT, 10_000).angles
    np.testing.assert_allclose(trip.angles, exact, rtol=0, atol=1e-9)
    cage, shaft = exact[:, 1], exact[:, 0]
    directions = np.stack([np.cos(cage), np.sin(cage), np.cos(shaft), np.sin(shaft)], axis=1)
    np.testing.assert_allclose(trip.directions, directions, rtol=0, atol=1e-9)


@law
@given(wandering_records(), st.integers(1, 7))
def test_how_a_record_turns_does_not_depend_on_the_step(drawn, n_steps):
    coarse = march_lanes([drawn], 100, n_steps, KNOT)[0]
    fine = march_lanes([drawn], 100, 8, KNOT)[0]
    np.testing.assert_array_equal(coarse.angles, fine.angles)
    np.testing.assert_allclose(coarse.directions, fine.directions, rtol=0, atol=1e-12)


@law
@given(wandering_records())
def test_without_wander_shaft_cage_and_balls_turn_at_the_rates_of_their_orders(drawn):
    steady = drawn._replace(turning=drawn.turning._replace(speed_rms=0.0, slip_rms=0.0, spin_rms=0.0))
    trip = march_lanes([steady], 120, 1, KNOT)[0]
    turns = (trip.angles[-1] - trip.angles[0]) / (2 * np.pi * 120 * KNOT * steady.turning.shaft_rate)
    found = slipping_orders(steady.bearing, steady.turning.mean_slip)
    np.testing.assert_allclose(turns, [1.0, found.ftf, found.bsf], rtol=1e-9)


@law
@given(wandering_records())
def test_the_processes_have_the_rms_they_were_drawn_with(drawn):
    far_apart = np.random.default_rng(0).uniform(0, 1e5, 20_000)
    values = process(drawn, 0, SPEED_TERMS, far_apart)
    assert np.sqrt(np.mean(values**2)) == pytest.approx(1.0, rel=0.05)


@law
@given(machines(), wandering_turnings(), angles, seeds)
def test_a_ball_whose_axis_has_left_the_track_does_not_feel_its_spalls(machine, motion, angle, seed):
    """The ball carries load at the start of the record; an unloaded ball feels no spall on its track."""
    under_load = math.atan2(machine.load_y, machine.load_x) - 2 * 2 * math.pi / 9
    off_track = motion._replace(cage_angle=under_load, axis_offset=0.2, axis_rms=0.0, axis_limit=0.1)
    spalls = [SpallInput("ball", 1e-3, 1e-4, angle, 2), SpallInput("ball", 1e-3, 1e-4, angle + 1, 2)]
    smooth = [spall._replace(depth=0.0) for spall in spalls]
    on_track = off_track._replace(axis_offset=0.0)
    missed, healthy, felt = march_lanes(
        [
            record(machine, off_track, spalls, seed=seed),
            record(machine, off_track, smooth, seed=seed),
            record(machine, on_track, spalls, seed=seed),
        ],
        1500,
        8,
        KNOT,
    )
    np.testing.assert_array_equal(missed.states, healthy.states)
    assert not np.array_equal(felt.states, healthy.states)


@law
@given(machines(), wandering_turnings(), seeds)
def test_a_wavy_race_shakes_what_an_even_one_does_not(machine, motion, seed):
    even = motion._replace(jitter_rms=1e-12)
    flat = [SpallInput("inner", 1e-4, 0.0, 0.0), SpallInput("inner", 1e-4, 0.0, 1.0)]
    calm, wavy = (
        march_lanes([record(machine, even, flat, seed=seed, waviness=rms)], 1200, 8, KNOT)[0] for rms in (0.0, 1e-7)
    )
    assert np.std(wavy.accelerations[4800:]) > np.std(calm.accelerations[4800:])


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
