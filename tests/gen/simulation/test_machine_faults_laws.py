"""Laws of machine faults: play, misalignment, a bent shaft, a knocking cage, varying load and speed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import kstest

from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.physics.kernel.outer_forces import KNOCK_SCATTER, KNOCK_SECONDS
from gen.physics.kernel_input import Turning
from gen.physics.rotor import as_columns, rest
from tests.lanes import march_lanes
from tests.reference_motion import knock_scatter
from tests.strategies import RIG, angles, record

law = settings(max_examples=8)
KNOT = 1 / 12_000
STANDING, CONSTANT = Turning(0.0), np.ones((1, 2))
PLACES = 2 * np.pi * np.arange(9)[None] / 9  # of the balls of a cage that has not turned
loads = st.floats(-500, -50) | st.floats(50, 500)
plays = st.floats(1e-7, 1e-4)


def scheduled(machine, motion, schedule=CONSTANT):
    return record(machine, motion)._replace(schedule=np.asarray(schedule))


@law
@given(loads, loads, plays)
def test_a_loose_housing_lies_at_one_end_of_its_play(load_x, load_y, play):
    tight = RIG._replace(load_x=load_x, load_y=load_y)
    loose = tight._replace(looseness=play)
    there = rest(as_columns([loose]), PLACES)[0]
    shift = play * np.sign([load_x, load_y])
    np.testing.assert_allclose(there, rest(as_columns([tight]), PLACES)[0] + np.tile(shift, 2), rtol=0, atol=1e-12)
    let_go = march_lanes([scheduled(loose, STANDING)], 6000, 8, KNOT, np.zeros(12))[0]  # 0.5 s
    np.testing.assert_allclose(let_go.states[-1, :4], there, rtol=0, atol=1e-11)


@law
@given(st.floats(1000, 50_000), st.floats(1, 100), angles, st.floats(0.3, 3.0))
def test_a_cage_knocks_once_a_turn_with_the_momentum_of_a_half_sine(knots_per_second, strength, place, ahead):
    """On a housing without support; each knock scatters independently."""
    free = RIG._replace(
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


def test_a_schedule_that_is_over_holds_whatever_its_neighbours_do():
    motion, short = Turning(30.0), np.linspace([1.0, 1.0], [1.5, 2.0], 50)
    long = scheduled(RIG, motion, np.linspace([1.0, 1.0], [0.5, 3.0], 500))
    alone = march_lanes([scheduled(RIG, motion, short)], 600, 8, KNOT)[0]
    beside = march_lanes([scheduled(RIG, motion, short), long], 600, 8, KNOT)[0]
    np.testing.assert_array_equal(alone.states, beside.states)
    assert alone.angles[-1, 0] == pytest.approx(2 * np.pi * 30 * KNOT * (short[:, 0].sum() + 550 * 1.5))


def test_knocks_scatter_log_normally_and_differ_from_cage_to_cage():
    logs = np.log([[knock_scatter(turn, seed) for turn in range(2000)] for seed in (1, 2)]) / KNOCK_SCATTER
    assert kstest(logs[0], "norm").pvalue > 0.01
    assert abs(np.corrcoef(logs)[0, 1]) < 0.1
    spectrum = np.abs(np.fft.rfft(logs[0])) ** 2
    assert spectrum[1:].max() < 15 * spectrum[1:].mean()  # no tone
