"""From one knot to the next: how shaft, cage and balls move, and what pulls at them, while the kernel takes its steps.

Speed, slip, spin, jitter and spin-axis wander are sums of a few cosines with drawn frequencies and phases; each cosine is a phasor
turned once per knot, so no process needs a table in memory and none depends on the step.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.kernel import (
    CAGE_C,
    CAGE_TURN_C,
    CAGE_TURN_S,
    FORCES,
    SHAFT_C,
    SHAFT_TURN_C,
    SHAFT_TURN_S,
    UNBALANCE_P,
    UNBALANCE_Q,
    FloatArray,
    Shape,
    jitter_row,
)  # fmt: skip
from gen.physics.lanes import INLINE, LANES, UNFUSED, cosine, sine

# Rows of ``drive``: what a record's motion is made of.
(
    SHAFT_STEP, CAGE_RATIO, SPIN_RATIO, MEAN_SLIP, SPEED_RMS, SLIP_RMS, SPIN_RMS, JITTER_RMS, AXIS_OFFSET, AXIS_RMS, AXIS_LIMIT,
    UNBALANCE, CLEARANCE, BALL, INNER_RADIUS, OUTER_RADIUS, LOAD_X, LOAD_Y, TWICE_X, TWICE_Y, BOW, KNOCK, KNOCK_ANGLE, LATE_BALL, LATE_BY,
    KNOCK_SEED, DRIVE_ROWS,
) = range(27)  # fmt: skip
SHAFT, CAGE, SPIN, ANGLE_ROWS = range(4)  # rows of ``angles`` [rad]
SITE, POSITION, CARRIER, HALF, ARC, DEPTH, PROFILE, TABLE_ROW, SPALL_ROWS = range(9)  # rows of ``spalls``, per spall
NO_SITE, INNER, OUTER, BALL_SITE = range(4)

# Rows of the phasors: each process has its own, the jitter has JITTER_TERMS per ball.
SPEED_TERMS, SLIP_TERMS, SPIN_TERMS, AXIS_TERMS, JITTER_TERMS = 6, 12, 6, 8, 4
SLIP_FIRST = SPEED_TERMS
SPIN_FIRST = SLIP_FIRST + SLIP_TERMS
AXIS_FIRST = SPIN_FIRST + SPIN_TERMS
JITTER_FIRST = AXIS_FIRST + AXIS_TERMS

LOWEST_ORDER, HIGHEST_ORDER = 2, 60  # waviness per turn of a race
N_ORDERS = HIGHEST_ORDER - LOWEST_ORDER + 1
WAVE_ROWS = 4 * N_ORDERS  # real and imaginary amplitude of each order, inner race then outer race
# waviness per turn of a ball, even orders from 2 on: it has two contacts, and in the odd ones they cancel
BALL_ORDERS = 10
TABLE_POINTS = 513  # of a tabulated spall, from edge to edge
KNOCK_SECONDS = 3e-4  # a half sine
KNOCK_SCATTER = 0.3  # standard deviation of the logarithm of its strength


class Lanes(NamedTuple):
    """A batch of records, one per lane; arrays are flat, ``row * LANES + lane``, unless they say otherwise."""

    state: FloatArray
    params: FloatArray
    drive: FloatArray
    angles: FloatArray
    spalls: FloatArray
    phasors: FloatArray
    """Cosine, sine, and cosine and sine of the turn per knot, of every term: 4 blocks of rows."""
    waves: FloatArray
    """Waviness amplitudes [m], WAVE_ROWS rows and then those of the balls, ball after ball in each order; or empty."""
    schedule: FloatArray
    """Factors of shaft rate and load, shape (knot, 2, lane), or of shape (0, 2, lane) if both are constant."""
    tables: FloatArray
    """Drops of tabulated spalls, shape (table, point) [m]; a ball spall has two, for the inner and the outer race."""


@njit(**UNFUSED)
def turn_phasors(phasors: FloatArray, n_terms: int) -> None:
    """Turn every phasor by one knot."""
    block = n_terms * LANES
    for i in range(block):
        c, s = phasors[i], phasors[block + i]
        dc, ds = phasors[2 * block + i], phasors[3 * block + i]
        phasors[i] = c * dc - s * ds
        phasors[block + i] = s * dc + c * ds


@njit(**INLINE)
def process(phasors: FloatArray, first: int, terms: int, lane: int) -> float:
    """Value of a process of unit rms [1]."""
    total = 0.0
    for term in range(first, first + terms):
        total += phasors[term * LANES + lane]
    return total * math.sqrt(2.0 / terms)


@njit(**INLINE)
def wrapped(angle: float) -> float:
    """Angle in [-pi, pi]."""
    return angle - 2 * math.pi * np.rint(angle / (2 * math.pi))


@njit(**UNFUSED)
def turn_rings(lanes: Lanes, knot: int, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Set the turning rates to the next knot, and note how far shaft, cage and ball spin will move in ``moves``."""
    params, drive, phasors, state = lanes.params, lanes.drive, lanes.phasors, lanes.state
    for lane in range(LANES):
        speed = 1 + drive[SPEED_RMS * LANES + lane] * process(phasors, 0, SPEED_TERMS, lane)
        shaft = drive[SHAFT_STEP * LANES + lane] * speed
        if len(lanes.schedule):
            shaft *= lanes.schedule[min(knot, len(lanes.schedule) - 1), 0, lane]
        slip = drive[MEAN_SLIP * LANES + lane] + drive[SLIP_RMS * LANES + lane] * process(
            phasors, SLIP_FIRST, SLIP_TERMS, lane
        )
        cage = drive[CAGE_RATIO * LANES + lane] * shaft * (1 - slip)
        wander = 1 + drive[SPIN_RMS * LANES + lane] * process(phasors, SPIN_FIRST, SPIN_TERMS, lane)
        quickening = shaft - moves[SHAFT * LANES + lane] if knot > 0 else 0.0
        moves[SHAFT * LANES + lane] = shaft
        moves[CAGE * LANES + lane] = cage
        moves[SPIN * LANES + lane] = drive[SPIN_RATIO * LANES + lane] * shaft * wander
        half = 0.5 / n_steps
        params[CAGE_TURN_C * LANES + lane], params[CAGE_TURN_S * LANES + lane] = (
            cosine(cage * half),
            sine(cage * half),
        )
        params[SHAFT_TURN_C * LANES + lane], params[SHAFT_TURN_S * LANES + lane] = (
            cosine(shaft * half),
            sine(shaft * half),
        )
        per_knot = drive[UNBALANCE * LANES + lane] / (n_steps * dt) ** 2
        params[UNBALANCE_P * LANES + lane] = per_knot * shaft * shaft + drive[BOW * LANES + lane]
        params[UNBALANCE_Q * LANES + lane] = per_knot * quickening
        # a phasor turned 1e5 times keeps its angle to 1e-13, its length needs help
        for row in (CAGE_C, SHAFT_C):
            c, s = state[row * LANES + lane], state[(row + 1) * LANES + lane]
            stretch = 1.5 - 0.5 * (c * c + s * s)
            state[row * LANES + lane], state[(row + 1) * LANES + lane] = c * stretch, s * stretch


@njit(**INLINE)
def move_jitter(shape: Shape, lanes: Lanes, n_steps: int) -> None:
    """Let the jitter of every ball run from where it is to its value at the next knot."""
    params, drive = lanes.params, lanes.drive
    for ball in range(len(shape.balls)):
        row = jitter_row(shape) + 2 * ball
        for lane in range(LANES):
            eta = process(lanes.phasors, JITTER_FIRST + ball * JITTER_TERMS, JITTER_TERMS, lane)
            jitter = drive[JITTER_RMS * LANES + lane] * eta
            jitter += drive[LATE_BY * LANES + lane] if drive[LATE_BALL * LANES + lane] == ball else 0.0
            start = params[row * LANES + lane] + 2 * n_steps * params[(row + 1) * LANES + lane]
            params[row * LANES + lane] = start
            params[(row + 1) * LANES + lane] = (jitter - start) / (2 * n_steps)


@njit(**INLINE)
def pushed(since: float) -> float:
    """How far the half sine of a knock of unit strength has pushed a unit mass ``since`` its start [s2]."""
    if since <= 0.0:
        return 0.0
    phase = math.pi * since / KNOCK_SECONDS
    if phase >= math.pi:
        return (KNOCK_SECONDS / math.pi) ** 2 * (2 * phase - math.pi)
    return (KNOCK_SECONDS / math.pi) ** 2 * (phase - math.sin(phase))


@njit(**INLINE)
def uniform(number: float, seed: float) -> float:
    """Random number in (0, 1) that belongs to ``number`` and ``seed``, both whole: the finaliser of SplitMix64."""
    x = np.uint64(np.int64(number)) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(np.int64(seed))
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x ^= x >> np.uint64(31)
    return (np.float64(x >> np.uint64(12)) + 0.5) / 2.0**52


@njit(**INLINE)
def standard_normal(number: float, seed: float) -> float:
    """Random number of a standard normal distribution that belongs to ``number`` and ``seed`` (Box and Muller)."""
    return math.sqrt(-2 * math.log(uniform(2 * number, seed))) * math.cos(2 * math.pi * uniform(2 * number + 1, seed))


@njit(**INLINE)
def knock(lanes: Lanes, knot_seconds: float, ahead: float, lane: int, moves: FloatArray) -> float:
    """Force of the cage's knock on the housing, ``ahead`` knots from now: a half sine once per turn of the cage [N].

    The force runs straight from knot to knot and gives the momentum of the half sine however far apart the knots are. Its
    strength scatters from turn to turn, log-normally.
    """
    strength = lanes.drive[KNOCK * LANES + lane]
    if strength == 0.0:
        return 0.0
    turned = lanes.angles[CAGE * LANES + lane] - lanes.drive[KNOCK_ANGLE * LANES + lane]
    turned += ahead * moves[CAGE * LANES + lane]
    turns = math.floor(turned / (2 * math.pi) + 0.5)
    since = (turned - 2 * math.pi * turns) * knot_seconds / moves[CAGE * LANES + lane]
    if not -knot_seconds < since < KNOCK_SECONDS + knot_seconds:  # so is what a cage at a standstill gives
        return 0.0
    there = pushed(since + knot_seconds) - 2 * pushed(since) + pushed(since - knot_seconds)
    scatter = math.exp(KNOCK_SCATTER * standard_normal(turns, lanes.drive[KNOCK_SEED * LANES + lane]))
    return strength * scatter * there / knot_seconds**2


@njit(**INLINE)
def outer_forces(
    lanes: Lanes, knot: int, knot_seconds: float, ahead: float, lane: int, moves: FloatArray, force: FloatArray
) -> None:
    """Forces on shaft and housing ``ahead`` knots from now, into ``force`` (x and y of the shaft, then of the housing) [N].

    Misalignment pulls to and fro along its own direction, and most when the shaft's mark points that way or the opposite one.
    """
    drive = lanes.drive
    load = 1.0
    if len(lanes.schedule):
        load = lanes.schedule[min(knot + int(ahead), len(lanes.schedule) - 1), 1, lane]
    twice_x, twice_y = drive[TWICE_X * LANES + lane], drive[TWICE_Y * LANES + lane]
    turned = lanes.angles[SHAFT * LANES + lane] + ahead * moves[SHAFT * LANES + lane]
    pull = math.cos(2 * (turned - math.atan2(twice_y, twice_x)))
    hit, place = knock(lanes, knot_seconds, ahead, lane, moves), drive[KNOCK_ANGLE * LANES + lane]
    force[0] = load * drive[LOAD_X * LANES + lane] + pull * twice_x
    force[1] = load * drive[LOAD_Y * LANES + lane] + pull * twice_y
    force[2], force[3] = hit * math.cos(place), hit * math.sin(place)


@njit(**INLINE)
def move_forces(lanes: Lanes, knot: int, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Let the outer forces run from now to their values at the next knot."""
    params = lanes.params
    now, then = np.empty(4), np.empty(4)
    for lane in range(LANES):
        outer_forces(lanes, knot, n_steps * dt, 0.0, lane, moves, now)
        outer_forces(lanes, knot, n_steps * dt, 1.0, lane, moves, then)
        for row in range(4):
            params[(FORCES + row) * LANES + lane] = now[row]
            params[(FORCES + 4 + row) * LANES + lane] = (then[row] - now[row]) / (2 * n_steps)
