"""Laws of machine faults: play, misalignment, a bent shaft, a knocking cage, varying load and speed.

All tests share one kernel with varying forces and a support with play; tests without play use 1e-30 m.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import kstest

from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.physics.inputs import SpallInput, Turning
from gen.physics.kernel.outer_forces import KNOCK_SCATTER, KNOCK_SECONDS
from gen.physics.rotor import as_columns, rest
from tests.lanes import march_lanes
from tests.reference import knock_scatter
from tests.strategies import RIG, angles, record

law = settings(deadline=None, max_examples=15)
KNOT = 1 / 12_000
TIGHT = RIG._replace(looseness=1e-30)
STANDING, CONSTANT = Turning(0.0), np.ones((1, 2))
PLACES = 2 * np.pi * np.arange(9)[None] / 9  # of the balls of a cage that has not turned
loads = st.floats(-500, -50) | st.floats(50, 500)
plays = st.floats(1e-7, 1e-4)


def scheduled(machine, motion, schedule=CONSTANT):
    return record(machine, motion)._replace(schedule=np.asarray(schedule))


@law
@given(loads, loads, plays)
def test_a_loose_housing_lies_at_one_end_of_its_play(load_x, load_y, play):
    tight = TIGHT._replace(load_x=load_x, load_y=load_y)
    loose = tight._replace(looseness=play)
    there = rest(as_columns([loose]), PLACES)[0]
    shift = play * np.sign([load_x, load_y])
    np.testing.assert_allclose(there, rest(as_columns([tight]), PLACES)[0] + np.tile(shift, 2), rtol=0, atol=1e-12)
    let_go = march_lanes([scheduled(loose, STANDING)], 6000, 8, KNOT, np.zeros(12))[0]  # 0.5 s
    np.testing.assert_allclose(let_go.states[-1, :4], there, rtol=0, atol=1e-11)


@law
@given(angles, st.floats(10, 60))
def test_a_support_without_play_is_a_tight_one(cage, shaft_rate):
    motion = Turning(shaft_rate, cage_angle=cage, unbalance=2.75e-5)
    loose, none = scheduled(RIG._replace(looseness=1e-5), motion), scheduled(RIG, motion)
    tight = march_lanes([record(RIG, motion)], 240, 8, KNOT)[0]
    assert np.array_equal(march_lanes([loose, none], 240, 8, KNOT)[1].states, tight.states)


def swings(motions, turns=4):
    """Amplitudes of the shaft's motion at once and twice the shaft rate, shape (motion, line, axis) [m]."""
    stiff = TIGHT._replace(half_clearance=-12e-6, load_x=0.0, load_y=-10.0)
    found = []
    for motion in motions:
        settle, n_knots = 2400, round(turns / motion.shaft_rate / KNOT)
        trip = march_lanes([scheduled(stiff, motion)], settle + n_knots, 8, KNOT)[0]
        lines = np.fft.rfft(trip.states[settle:-1, :2], axis=0)[[turns, 2 * turns]]
        found.append(2 / n_knots * np.abs(lines))
    return np.array(found)


def test_a_bow_pulls_alike_at_any_speed_and_an_unbalance_with_its_square():
    """Far below the first resonance, some 400 Hz; the rest is its share of the rotor, (20 / 400)^2."""
    bow_10, bow_20, unbalance_10, unbalance_20 = swings(
        [Turning(10.0, bow=50.0), Turning(20.0, bow=50.0), Turning(10.0, unbalance=1e-2), Turning(20.0, unbalance=1e-2)]
    )[:, 0]
    np.testing.assert_allclose(bow_20 / bow_10, 1, rtol=5e-3)
    np.testing.assert_allclose(unbalance_20 / unbalance_10, 4, rtol=5e-3)
    np.testing.assert_allclose(unbalance_10 / bow_10, 1e-2 * (2 * np.pi * 10) ** 2 / 50, rtol=1e-3)


def test_misalignment_shakes_the_shaft_along_its_direction_at_twice_the_shaft_rate():
    along_x, along_y, straight = swings([Turning(20.0, twice_x=50.0), Turning(20.0, twice_y=50.0), Turning(20.0)])
    assert along_x[1, 0] > 100 * max(along_x[0, 0], along_x[1, 1], straight[1, 0])
    assert along_y[1, 1] > 100 * max(along_y[0, 1], along_y[1, 0], straight[1, 1])


@law
@given(st.floats(1000, 50_000), st.floats(1, 100), angles, st.floats(0.3, 3.0))
def test_a_cage_knocks_once_a_turn_with_the_momentum_of_a_half_sine(knots_per_second, strength, place, ahead):
    """On a housing without support; each knock scatters independently."""
    free = TIGHT._replace(
        half_clearance=1e-2, ring_damping=0.0, support_stiffness_x=1e-9, support_stiffness_y=1e-9,
        support_damping_x=0.0, support_damping_y=0.0, load_x=0.0, load_y=0.0,
    )  # fmt: skip
    motion = Turning(60.0, cage_angle=place - ahead, knock=strength, knock_angle=place, knock_seed=round(1e6 * ahead))
    turn = 1 / (60 * orders(CATALOGUE["6205"]).ftf)
    knot, n_steps = 1 / knots_per_second, math.ceil(100_000 / knots_per_second)
    n_knots = math.ceil(1.9 * turn / knot)
    trip = march_lanes([record(free, motion)._replace(schedule=CONSTANT)], n_knots, n_steps, knot, np.zeros(12))[0]
    momentum = free.housing_mass * trip.states[:, 8:10] + free.sensor_mass * trip.states[:, 10:12]
    along = momentum @ [math.cos(place), math.sin(place)]
    whole = strength * 2 * KNOCK_SECONDS / math.pi
    first = ahead / (2 * math.pi) * turn
    times = knot * np.arange(n_knots + 1)
    between = (times > first + KNOCK_SECONDS + 2 * knot) & (times < first + turn - 2 * knot)
    after = times > first + turn + KNOCK_SECONDS + 2 * knot
    scatter = [knock_scatter(turn, motion.knock_seed) for turn in (0, 1)]
    np.testing.assert_allclose(along[times < first - 2 * knot], 0, rtol=0, atol=1e-12 * whole)
    np.testing.assert_allclose(along[between], whole * scatter[0], rtol=1e-9)
    np.testing.assert_allclose(along[after], whole * sum(scatter), rtol=1e-9)
    assert between.any()
    assert after.any()


@law
@given(loads, loads, st.floats(0.2, 3.0))
def test_a_load_that_changes_ends_where_the_static_balance_of_its_end_says(load_x, load_y, end):
    machine = TIGHT._replace(load_x=load_x, load_y=load_y)
    schedule = np.stack([np.ones(601), np.linspace(1, end, 601)], axis=1)  # 50 ms
    trip = march_lanes([scheduled(machine, STANDING, schedule)], 6000, 8, KNOT)[0]
    there = rest(as_columns([machine._replace(load_x=end * load_x, load_y=end * load_y)]), PLACES)[0]
    np.testing.assert_allclose(trip.states[-1, :4], there, rtol=0, atol=1e-11)


@law
@given(st.floats(0, 2), st.floats(0, 2), st.floats(10, 60))
def test_a_run_up_turns_the_shaft_by_the_integral_of_its_rate(begin, end, shaft_rate):
    """Linear from one share of the rate to another, then constant; the cage knocks, even at a standstill."""
    n_knots, half = 400, 200
    shares = begin + (end - begin) * (np.arange(half) + 0.5) / half
    schedule = np.stack([np.append(shares, end), np.ones(half + 1)], axis=1)
    motion = Turning(shaft_rate, knock=10.0)
    trip = march_lanes([scheduled(TIGHT, motion, schedule)], n_knots, 8, KNOT)[0]
    turns = shaft_rate * half * KNOT * ((begin + end) / 2 + end)
    expected = 2 * np.pi * turns * np.array([1, orders(CATALOGUE["6205"]).ftf])
    np.testing.assert_allclose(trip.angles[-1, :2], expected, rtol=1e-12, atol=1e-12)
    assert np.isfinite(trip.states).all()


def test_a_schedule_that_is_over_holds_whatever_its_neighbours_do():
    motion, short = Turning(30.0), np.linspace([1.0, 1.0], [1.5, 2.0], 50)
    long = scheduled(TIGHT, motion, np.linspace([1.0, 1.0], [0.5, 3.0], 500))
    alone = march_lanes([scheduled(TIGHT, motion, short)], 600, 8, KNOT)[0]
    beside = march_lanes([scheduled(TIGHT, motion, short), long], 600, 8, KNOT)[0]
    np.testing.assert_array_equal(alone.states, beside.states)
    assert alone.angles[-1, 0] == pytest.approx(2 * np.pi * 30 * KNOT * (short[:, 0].sum() + 550 * 1.5))


def test_knocks_scatter_log_normally_and_differ_from_cage_to_cage():
    logs = np.log([[knock_scatter(turn, seed) for turn in range(2000)] for seed in (1, 2)]) / KNOCK_SCATTER
    assert kstest(logs[0], "norm").pvalue > 0.01
    assert abs(np.corrcoef(logs)[0, 1]) < 0.1
    spectrum = np.abs(np.fft.rfft(logs[0])) ** 2
    assert spectrum[1:].max() < 15 * spectrum[1:].mean()  # no tone


@pytest.mark.parametrize("late_by", [0.0, 0.1, 0.3, 0.6])
def test_a_ball_meets_a_spall_wherever_it_is_in_its_pocket(late_by):
    """One ball far out of its place, at standstill, lies in the spall at that place.

    Jitter and damping close to zero, and a spall of depth zero, let both records share a kernel that other tests use too.
    """
    motion = Turning(1e-6, jitter_rms=1e-12, late_ball=0, late_by=late_by)
    across = {"load_x": 300 * math.cos(late_by), "load_y": 300 * math.sin(late_by)}
    machine = RIG._replace(half_clearance=0.0, contact_damping=1e-3, **across)
    records = [record(machine, motion, [SpallInput("outer", 0.5e-3, depth, late_by)]) for depth in (0.0, 1e-3)]
    sound, spalled = (trip.states[-1] for trip in march_lanes(records, 600, 8, KNOT))
    assert (spalled - sound)[:2] @ [math.cos(late_by), math.sin(late_by)] > 1e-6
