"""Symmetries: a rotated or mirrored machine gives the rotated or mirrored record, and a spall that no ball meets changes nothing."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.extent import HIGHEST_ORDER, LOWEST_ORDER
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.layout import N_DYNAMIC
from gen.physics.kernel_input import Waviness, at_rest
from tests.lanes import march_lanes
from tests.strategies import angles, troubled_records

law = settings(max_examples=10)
KNOT = 1 / 12_000
N_KNOTS = 600  # 50 ms


def turned(vector, turn):
    """Pairs (..., axis) turned about the shaft."""
    c, s = math.cos(turn), math.sin(turn)
    return np.asarray(vector) @ np.array([[c, s], [-s, c]])


def isotropic(machine):
    return machine._replace(
        ring_stiffness_y=machine.ring_stiffness_x,
        support_stiffness_y=machine.support_stiffness_x,
        support_damping_y=machine.support_damping_x,
        sensor_stiffness_y=machine.sensor_stiffness_x,
    )


def turned_record(there, turn):
    """The record with load, misalignment, knock, shaft, cage and outer race turned; the inner race turns with the shaft."""
    machine, motion = there.machine, there.turning
    load_x, load_y = turned([machine.load_x, machine.load_y], turn)
    twice_x, twice_y = turned([motion.twice_x, motion.twice_y], turn)
    return there._replace(
        machine=machine._replace(load_x=load_x, load_y=load_y),
        turning=motion._replace(
            shaft_angle=motion.shaft_angle + turn,
            cage_angle=motion.cage_angle + turn,
            knock_angle=motion.knock_angle + turn,
            twice_x=twice_x,
            twice_y=twice_y,
        ),
        spalls=tuple(
            spall._replace(angle=spall.angle + turn) if spall.site == "outer" else spall for spall in there.spalls
        ),
    )


def rest_of(drawn):
    """State in which a record starts, shape (coordinate,)."""
    return lay_out(at_rest([drawn]), input_shape(drawn), KNOT).state.reshape(-1, LANES)[:N_DYNAMIC, 0]


@law
@given(troubled_records(), angles, st.floats(-1e-5, 1e-5))
def test_a_machine_turned_as_a_whole_gives_the_turned_record(drawn, turn, off):
    """Without play in the support, which is square, and without waviness of the outer race, whose amplitudes count from x."""
    even = drawn.waviness._replace(races=drawn.waviness.races * [[1], [0]])
    here = without_counted_chances(drawn)._replace(
        machine=isotropic(drawn.machine)._replace(looseness=1e-30), waviness=even
    )
    start = rest_of(here) + off * np.repeat([1.0, 100.0], 6)
    moved = turned_record(here, turn)
    trip, near = (turned(way, turn) for way in (ways(here, start), nearby(here, start)))
    other = ways(moved, turned(start.reshape(6, 2), turn).ravel())
    assert_alike(trip, other, near)


def ways(there, start):
    """Displacements and rates of a record from its start, shape (knot, pair, axis)."""
    return march_lanes([there], N_KNOTS, 8, KNOT, start)[0].states.reshape(-1, 6, 2)


def nearby(there, start):
    """Trajectory displaced at the start by 1e-11 of the largest displacement, about 1e5 roundings, with angles changed accordingly.

    Angles are summed knot by knot. At a constant rate all roundings may have one sign, and in the mirror the other: after 600 knots angles
    of up to 60 rad differ by their sum, and a ball meets a spall earlier or later by that angle.
    """
    motion, off = there.turning, N_KNOTS * np.spacing(60.0)
    motion = motion._replace(
        shaft_angle=motion.shaft_angle - off, cage_angle=motion.cage_angle + off, spin_angle=motion.spin_angle + off
    )
    aside = 1e-11 * np.abs(start[:6]).max() * np.repeat([1.0, 0.0], 6)
    return ways(there._replace(turning=motion), start + aside)


def assert_alike(trip, other, near):
    """Equal except for rounding, which play in the support amplifies: the difference never exceeds that of ``near`` so far."""
    for part in (slice(0, 3), slice(3, 6)):
        apart, nearby, size = (np.abs(way[:, part]).max(axis=(1, 2)) for way in (other - trip, near - trip, trip))
        np.testing.assert_array_less(apart, np.maximum.accumulate(nearby) + 1e-11 * size.max())


def mirrored_waviness(waviness):
    """Waviness of rings and balls seen in the mirror x -> -x."""
    inner, outer = np.conj(waviness.races)
    sign = (-1.0) ** np.arange(LOWEST_ORDER, HIGHEST_ORDER + 1)
    return Waviness(np.stack([inner, outer * sign]), np.conj(waviness.balls[:, -np.arange(9)]))


def mirrored_spall(spall):
    return spall._replace(
        angle=math.pi - spall.angle if spall.site == "outer" else -spall.angle,
        ball=-spall.ball % 9,
        table=tuple(drops[::-1] for drops in spall.table),
    )


def without_counted_chances(there):
    """The record without random events that depend on the number of a passage or of a turn since angle 0."""
    return there._replace(
        turning=there.turning._replace(axis_jumps=0.0),
        spalls=tuple(spall._replace(scatter=0.0) for spall in there.spalls),
    )


def mirrored_turning(motion):
    return motion._replace(
        shaft_rate=-motion.shaft_rate,
        shaft_angle=math.pi - motion.shaft_angle,
        cage_angle=math.pi - motion.cage_angle,
        spin_angle=-motion.spin_angle,
        twice_x=-motion.twice_x,
        knock_angle=math.pi - motion.knock_angle,
        late_ball=-motion.late_ball % 9,
        late_by=-motion.late_by,
    )


@law
@given(troubled_records())
def test_a_mirrored_machine_gives_the_mirrored_record(drawn):
    """x -> -x: angles become pi minus themselves, the shaft turns the other way, ball i becomes ball -i.

    At half the shaft rate the cage knocks only once: the force of later knocks depends on the number of turns. Jitter is almost zero.
    """
    slow = drawn.turning._replace(jitter_rms=1e-30, shaft_rate=drawn.turning.shaft_rate / 2)
    there = without_counted_chances(drawn._replace(turning=slow))
    mirrored = there._replace(
        machine=there.machine._replace(load_x=-there.machine.load_x),
        turning=mirrored_turning(there.turning),
        spalls=tuple(map(mirrored_spall, there.spalls)),
        waviness=mirrored_waviness(there.waviness),
    )
    sign, start = np.tile([-1.0, 1.0], 6), rest_of(there)
    trip, near = (way * sign.reshape(6, 2) for way in (ways(there, start), nearby(there, start)))
    assert_alike(trip, ways(mirrored, start * sign), near)
