"""What moves along a straight line between two knots in the NumPy twin of :mod:`tests.reference`: angles, gaps and outer forces.

Angles are angles, and every process is the sum of cosines that was drawn.
"""

import math
from typing import NamedTuple

import numpy as np

from gen.physics.extent import BALL_ORDERS, HIGHEST_ORDER, LOWEST_ORDER
from gen.physics.kernel.layout import (
    JITTER_FIRST,
    JITTER_TERMS,
    SLIP_FIRST,
    SLIP_TERMS,
    SPEED_TERMS,
    SPIN_FIRST,
    SPIN_TERMS,
    TILT_FIRST,
    TILT_TERMS,
    FloatArray,
)
from gen.physics.kernel.outer_forces import KNOCK_SCATTER, KNOCK_SECONDS
from gen.physics.kernel.turning import STRIDE
from gen.physics.kernel_input import KernelInput, Turning


class Slow(NamedTuple):
    """What moves along a straight line between two knots."""

    angles: FloatArray
    """Of shaft, cage and ball spin, shape (knot, angle) [rad]."""
    gaps: FloatArray
    """Under each ball, waviness taken off, shape (knot, ball) [m]."""
    jitter: FloatArray
    """Of each ball in its pocket, shape (knot, ball) [rad]."""
    directions: FloatArray
    """Of each ball as the cage sees it, straight between the nodes of the processes, shape (knot, ball, axis) [1]."""
    rates: FloatArray
    """Of shaft, cage and ball spin up to the next knot, shape (knot, angle) [rad/s]."""
    forces: FloatArray
    """Outer forces on shaft and housing, x and y, now and just before the next knot, shape (knot, 2, 4) [N]."""
    share: FloatArray
    """Of its drop that a ball spall gives up to this knot, shape (knot,) [1]."""
    shift: FloatArray
    """Angle by which the jump of the spin axis has turned the spin, shape (knot,) [rad]."""


def process(record: KernelInput, first: int, terms: int, times: FloatArray) -> FloatArray:
    """Values of a process of unit rms, shape (time,)."""
    some = slice(first, first + terms)
    turns = 2 * np.pi * np.outer(times, record.frequencies[some]) + record.phases[some]
    return math.sqrt(2 / terms) * np.cos(turns).sum(axis=1)


def straight(record: KernelInput, knot: float, first: int, terms: int, when: FloatArray) -> FloatArray:
    """A process of unit rms along straight lines between its nodes, shape (time,)."""
    nodes = STRIDE * knot * np.arange(int(when[-1] / knot) // STRIDE + 2)
    return np.interp(when, nodes, process(record, first, terms, nodes))


def turned(record: KernelInput, knot: float, n_knots: int) -> tuple[FloatArray, FloatArray]:
    """Angles of shaft, cage and ball spin at the knots, and their rates up to the next knot, as they are halfway."""
    bearing, drawn = record.bearing, record.turning
    gamma, size = bearing.gamma, bearing.pitch_diameter / bearing.ball_diameter
    halfway = knot * (np.arange(n_knots + 1) + 0.5)
    shaft = 2 * np.pi * drawn.shaft_rate * (1 + drawn.speed_rms * straight(record, knot, 0, SPEED_TERMS, halfway))
    shaft = shaft * scheduled(record, n_knots + 1)[:, 0]
    slip = drawn.mean_slip + drawn.slip_rms * straight(record, knot, SLIP_FIRST, SLIP_TERMS, halfway)
    slip = slip + walk(record, knot, n_knots + 1)
    wander = 1 + drawn.spin_rms * straight(record, knot, SPIN_FIRST, SPIN_TERMS, halfway)
    rates = np.stack([shaft, shaft * (1 - gamma) / 2 * (1 - slip), shaft * size / 2 * (1 - gamma**2) * wander], axis=1)
    start = np.array([drawn.shaft_angle, drawn.cage_angle, drawn.spin_angle])
    return start + np.concatenate([np.zeros((1, 3)), np.cumsum(knot * rates[:-1], axis=0)]), rates


def slow_motion(record: KernelInput, knot: float, n_knots: int) -> Slow:
    """Slow quantities at the knots, ``knot`` seconds apart."""
    bearing, drawn = record.bearing, record.turning
    nodes = STRIDE * knot * np.arange(n_knots // STRIDE + 2)
    times = np.linspace(0, knot * n_knots, n_knots + 1)
    angles, rates = turned(record, knot, n_knots)
    balls = np.arange(bearing.n_balls)
    at_nodes = np.stack(
        [
            drawn.jitter_rms * process(record, JITTER_FIRST + ball * JITTER_TERMS, JITTER_TERMS, nodes)
            + (drawn.late_by if ball == drawn.late_ball else 0.0)
            for ball in balls
        ],
        axis=1,
    )
    jitter = np.stack([np.interp(times, nodes, of_ball) for of_ball in at_nodes.T], axis=1)
    seats = 2 * np.pi * balls / bearing.n_balls + at_nodes
    directions = np.stack(
        [[np.interp(times, nodes, of_ball) for of_ball in towards(seats).T] for towards in (np.cos, np.sin)]
    ).transpose(2, 1, 0)
    places = angles[:, 1:2] + 2 * np.pi * balls / bearing.n_balls
    height = waviness(record, places - angles[:, :1], places) + ball_waviness(record, angles[:, 2])
    gaps = record.machine.half_clearance - height
    jumped, shift = jumps(record, angles[:, 1])
    # the share holds up to the next knot: its tilt is that at the end, but a jump counts from the start
    jumped = np.concatenate([[0.0], jumped[:-1]])
    tilt = drawn.axis_offset + drawn.axis_rms * straight(record, knot, TILT_FIRST, TILT_TERMS, times) + jumped
    share = np.maximum(0.0, 1 - (tilt / drawn.axis_limit) ** 2) if drawn.axis_limit > 0 else np.ones(n_knots + 1)
    return Slow(angles, gaps, jitter, directions, rates, outer_forces(record, knot, angles, rates), share, shift)


def walk(record: KernelInput, knot: float, n_knots: int) -> FloatArray:
    """Slip that is new every ``STRIDE`` knots and lets the angle of the cage walk at random, shape (knot,) [1]."""
    drawn = record.turning
    apart = 2 * np.pi / record.bearing.n_balls
    turned = 2 * np.pi * abs(drawn.shaft_rate) * (1 - record.bearing.gamma) / 2 * STRIDE * knot
    seen = [standard_normal(at // STRIDE, drawn.walk_seed) if drawn.walk > 0 else 0.0 for at in range(n_knots)]
    return drawn.walk * math.sqrt(apart / turned) * np.array(seen)


def jumps(record: KernelInput, cage: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Tilt and shift of the spin angle since the last jump of the axis of the damaged ball, each of shape (knot,) [rad]."""
    drawn, machine = record.turning, record.machine
    carrier = next((spall.ball for spall in record.spalls if spall.site == "ball"), 0)
    opposite = math.atan2(-machine.load_y, -machine.load_x) - carrier * 2 * np.pi / record.bearing.n_balls
    turns = np.floor((cage - opposite) / (2 * np.pi)).astype(int)
    last, found = None, np.zeros((len(cage), 2))
    for at, turn in enumerate(turns.tolist()):
        moved = at == 0 or (turn != turns[at - 1] and split_mix(8 * turn, drawn.axis_seed) < drawn.axis_jumps)
        last = turn if moved else last
        if drawn.axis_jumps > 0:
            found[at] = [drawn.axis_spread * standard_normal(4 * last + k, drawn.axis_seed) for k in (1, 2)]
    return found[:, 0], found[:, 1]


def scheduled(record: KernelInput, n_knots: int) -> FloatArray:
    """Factors of shaft rate and load, the last ones held, shape (knot, 2) [1]."""
    if len(record.schedule) == 0:
        return np.ones((n_knots, 2))
    return record.schedule[np.minimum(np.arange(n_knots), len(record.schedule) - 1)]


def outer_forces(record: KernelInput, knot: float, angles: FloatArray, rates: FloatArray) -> FloatArray:
    """See :class:`Slow`."""
    drawn, n_knots = record.turning, len(angles)
    load = scheduled(record, n_knots + 1)[:, 1]
    out = np.array([math.cos(drawn.knock_angle), math.sin(drawn.knock_angle)])
    forces = np.empty((n_knots, 2, 4))
    for at, end in np.ndindex(n_knots, 2):
        shaft, cage, _ = angles[at] + end * knot * rates[at]
        mark, misaligned = np.array([math.cos(shaft), math.sin(shaft)]), np.array([drawn.twice_x, drawn.twice_y])
        size = max(np.hypot(*misaligned), 1e-300)
        pull = load[at + end] * np.array([record.machine.load_x, record.machine.load_y])
        pull += misaligned * (2 * (mark @ misaligned / size) ** 2 - 1)
        forces[at, end] = *pull, *(knock(drawn, cage, rates[at, 1], knot) * out)
    return forces


def knock(drawn: Turning, cage: float, rate: float, knot: float) -> float:
    """Mean of all knocks over the hat that is 1 at this knot and 0 at its neighbours [N]."""
    if drawn.knock == 0:
        return 0.0
    past = cage - drawn.knock_angle
    total = 0.0
    for turn in range(math.floor(past / (2 * math.pi)) - 1, math.floor(past / (2 * math.pi)) + 3):
        since = (past - 2 * math.pi * turn) / rate
        strength = drawn.knock * knock_scatter(turn, drawn.knock_seed)
        total += strength * (half_sine_under_slope(since, -knot) + half_sine_under_slope(since, knot)) / knot
    return total


def knock_scatter(turn: int, seed: int) -> float:
    """Log-normal factor of the knock of a turn [1]."""
    return math.exp(KNOCK_SCATTER * standard_normal(turn, seed))


def standard_normal(number: int, seed: int) -> float:
    """Normal number from two uniform numbers by Box and Muller."""
    first, second = (split_mix(2 * number + k, seed) for k in (0, 1))
    return math.sqrt(-2 * math.log(first)) * math.cos(2 * math.pi * second)


def split_mix(number: int, seed: int) -> float:
    """Number in (0, 1): the finaliser of SplitMix64 in whole numbers."""
    x = (number * 0x9E3779B97F4A7C15 + seed) % 2**64
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9 % 2**64
    x = (x ^ x >> 27) * 0x94D049BB133111EB % 2**64
    return (((x ^ x >> 31) >> 12) + 0.5) / 2**52


NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)  # of Gauss and Legendre, for integrals over part of a half sine


def half_sine_under_slope(since: float, reach: float) -> float:
    """Integral of the unit half sine that began ``since`` seconds ago, under a line from 1 now to 0 at ``reach`` from now [s]."""
    low, high = np.clip(sorted((since, since + reach)), 0.0, KNOCK_SECONDS)
    at = (low + high) / 2 + (high - low) / 2 * NODES
    line = 1 - (at - since) / reach
    return float((high - low) / 2 * WEIGHTS @ (np.sin(np.pi * at / KNOCK_SECONDS) * line))


def waviness(record: KernelInput, on_inner: FloatArray, on_outer: FloatArray) -> FloatArray:
    """Height of both races under balls at angles measured from each race's own mark, shape of the angles [m]."""
    height = np.zeros_like(on_outer)
    if record.waviness.races.size:
        orders = np.arange(LOWEST_ORDER, HIGHEST_ORDER + 1)
        for amplitudes, angles in zip(record.waviness.races, (on_inner, on_outer), strict=True):
            height += (amplitudes * np.exp(1j * angles[..., None] * orders)).real.sum(axis=-1)
    return height


def ball_waviness(record: KernelInput, spin: FloatArray) -> FloatArray:
    """Height of every ball over both its contacts at the spin angles ``spin``, shape (time, ball) [m]."""
    orders = 2 * np.arange(1, BALL_ORDERS + 1)
    height = np.zeros((len(spin), record.bearing.n_balls))
    if record.waviness.balls.size:
        height += (np.exp(1j * np.outer(spin, orders)) @ record.waviness.balls).real
    return height
