"""From one knot to the next: how shaft, cage and balls move, and what pulls at them, while the kernel takes its steps.

Speed, slip, spin, jitter and spin-axis wander are sums of a few cosines with drawn frequencies and phases; each cosine is a phasor
turned every ``STRIDE`` knots, between which the processes move along straight lines: no process needs a table in memory, and none
depends on the step.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.kernel.compiling import CALLED, INLINE, LANES, cosine, fma, lane_count, sine, wide
from gen.physics.kernel.equations import (
    CAGE_C,
    CAGE_TURN_C,
    CAGE_TURN_S,
    COS,
    FORCES,
    SHAFT_C,
    SHAFT_S,
    SHAFT_TURN_C,
    SHAFT_TURN_S,
    SIN,
    UNBALANCE_P,
    UNBALANCE_Q,
    FloatArray,
    Shape,
    direction_row,
)  # fmt: skip

# Rows of ``drive``: what a record's motion is made of.
(
    SHAFT_STEP, CAGE_RATIO, SPIN_RATIO, MEAN_SLIP, SPEED_RMS, SLIP_RMS, SPIN_RMS, JITTER_RMS, AXIS_OFFSET, AXIS_RMS, AXIS_LIMIT,
    UNBALANCE, CLEARANCE, BALL, INNER_RADIUS, OUTER_RADIUS, LOAD_X, LOAD_Y, TWICE_X, TWICE_Y, TWICE_C, TWICE_S, BOW, KNOCK, KNOCK_ANGLE,
    LATE_BALL, LATE_BY, KNOCK_SEED, DRIVE_ROWS,
) = range(29)  # fmt: skip
SHAFT, CAGE, SPIN, ANGLE_ROWS = range(4)  # rows of ``angles`` [rad]
# Rows of ``spalls``, per spall: how it moves past the balls with cage, shaft and ball spin, from which place, how often a ball comes by,
# and from how far a ball may meet it; then what it is.
(
    WITH_CAGE, WITH_SHAFT, WITH_SPIN, POSITION, PERIOD, REACH, SITE, CARRIER, HALF, ARC, DEPTH, PROFILE, TABLE_ROW, SPALL_ROWS,
) = range(14)  # fmt: skip
NO_SITE, INNER, OUTER, BALL_SITE = range(4)

STRIDE = 8  # knots along which processes move straight: their fastest terms, at twice the shaft rate, take tens of knots to a cycle
# Rows of ``slow``: speed, slip, spin and tilt of the spin axis, then the jitter of every ball [rad], and the slopes of all per knot.
SPEED, SLIP, WANDER, TILT, JITTER = range(5)

# Rows of the phasors: each process has its own, and so has the jitter of every ball.
SPEED_TERMS, SLIP_TERMS, SPIN_TERMS, AXIS_TERMS, JITTER_TERMS = 6, 12, 6, 8, 4
SLIP_FIRST = SPEED_TERMS
SPIN_FIRST = SLIP_FIRST + SLIP_TERMS
AXIS_FIRST = SPIN_FIRST + SPIN_TERMS
JITTER_FIRST = AXIS_FIRST + AXIS_TERMS
FOUR, SIX, EIGHT, TWELVE = ((None,) * terms for terms in (4, 6, 8, 12))

LOWEST_ORDER, HIGHEST_ORDER = 2, 60  # waviness per turn of a race
N_ORDERS = HIGHEST_ORDER - LOWEST_ORDER + 1
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
    """Cosine, sine, and cosine and sine of the turn per ``STRIDE`` knots: four rows for every term."""
    slow: FloatArray
    """Values of the processes, JITTER + n_balls rows, then their slopes per knot."""
    waves: FloatArray
    """Waviness amplitudes [m]: real and imaginary part of every order from 0 on of the inner race, ``n_terms`` times the number of balls,
    then of the outer one, then ball after ball of each even order; or empty."""
    schedule: FloatArray
    """Factors of shaft rate and load, shape (knot, 2, lane), or of shape (0, 2, lane) if both are constant."""
    tables: FloatArray
    """Drops of tabulated spalls, shape (table, point) [m]; a ball spall has two, for the inner and the outer race."""


@njit(**CALLED)
def n_terms(shape: Shape) -> int:
    """Number of orders of a race that differ by the number of balls."""
    return HIGHEST_ORDER // len(shape.balls) + 1


@njit(**CALLED)
def race_rows(shape: Shape) -> int:
    """Number of rows of ``waves`` that belong to the races."""
    return 4 * n_terms(shape) * len(shape.balls)


@njit(**CALLED)
def slow_rows(shape: Shape) -> int:
    """Number of processes."""
    return JITTER + (len(shape.balls) if len(shape.jittered) else 0)


@njit(**INLINE)
def turn_and_sum(
    terms: tuple[None, ...],
    turning: tuple[None, ...],
    first: int,
    rms: int,
    phasors: FloatArray,
    drive: FloatArray,
    values: FloatArray,
) -> None:
    """Turn the phasors of a process by ``STRIDE`` knots, unless ``turning`` is empty, and put its value into ``values``."""
    wide()
    own, size, scale = phasors[4 * first * LANES :], drive[rms * LANES :], math.sqrt(2.0 / len(terms))
    for lane in range(lane_count()):
        total = 0.0
        for term in range(len(terms)):
            i = 4 * term * LANES + lane
            c = own[i]
            if len(turning):
                s, dc, ds = own[i + LANES], own[i + 2 * LANES], own[i + 3 * LANES]
                c, s = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)
                own[i], own[i + LANES] = c, s
            total += c
        values[lane] = scale * total * size[lane]


@njit(**INLINE)
def processes(shape: Shape, lanes: Lanes, turning: tuple[None, ...], values: FloatArray) -> None:
    """Values of all processes, rows as in ``slow``, after their phasors have turned; see :func:`turn_and_sum`."""
    phasors, drive = lanes.phasors, lanes.drive
    turn_and_sum(SIX, turning, 0, SPEED_RMS, phasors, drive, values[SPEED * LANES :])
    turn_and_sum(TWELVE, turning, SLIP_FIRST, SLIP_RMS, phasors, drive, values[SLIP * LANES :])
    turn_and_sum(SIX, turning, SPIN_FIRST, SPIN_RMS, phasors, drive, values[WANDER * LANES :])
    turn_and_sum(EIGHT, turning, AXIS_FIRST, AXIS_RMS, phasors, drive, values[TILT * LANES :])
    for ball in range(len(shape.balls) if len(shape.jittered) else 0):
        jitter, first = values[(JITTER + ball) * LANES :], JITTER_FIRST + ball * JITTER_TERMS
        turn_and_sum(FOUR, turning, first, JITTER_RMS, phasors, drive, jitter)
        for lane in range(lane_count()):
            late = drive[LATE_BALL * LANES + lane] == ball
            jitter[lane] += drive[LATE_BY * LANES + lane] if late else 0.0


@njit(**INLINE)
def start_processes(shape: Shape, lanes: Lanes) -> None:
    """Processes at the first knot."""
    processes(shape, lanes, (), lanes.slow)


@njit(**INLINE)
def move_processes(shape: Shape, lanes: Lanes, n_steps: int, after: FloatArray) -> None:
    """Let every process, and the direction of every ball in its pocket, run straight to its value ``STRIDE`` knots from now.

    ``after`` is a work array of as many rows as there are processes.
    """
    wide()
    processes(shape, lanes, (None,), after)
    rows = slow_rows(shape)
    if len(shape.jittered):
        for ball in range(len(shape.balls)):
            line = lanes.params[(direction_row(shape) + 4 * ball) * LANES :]
            before, behind = lanes.slow[(JITTER + ball) * LANES :], after[(JITTER + ball) * LANES :]
            ball_c, ball_s = COS[len(shape.balls), ball], SIN[len(shape.balls), ball]
            for lane in range(lane_count()):
                c, s = cosine(before[lane]), sine(before[lane])
                start_c, start_s = fma(ball_c, c, -(ball_s * s)), fma(ball_s, c, ball_c * s)
                c, s = cosine(behind[lane]), sine(behind[lane])
                line[lane], line[LANES + lane] = start_c, start_s
                per_half_step = 1 / (2 * n_steps * STRIDE)
                line[2 * LANES + lane] = (fma(ball_c, c, -(ball_s * s)) - start_c) * per_half_step
                line[3 * LANES + lane] = (fma(ball_s, c, ball_c * s) - start_s) * per_half_step
    slopes = lanes.slow[rows * LANES :]
    for i in range(rows * lane_count()):
        slopes[i] = (after[i] - lanes.slow[i]) * (1 / STRIDE)


@njit(**INLINE)
def wrapped(angle: float) -> float:
    """Angle in [-pi, pi]."""
    return angle - 2 * math.pi * np.rint(angle / (2 * math.pi))


@njit(**INLINE)
def turn_rings(shape: Shape, lanes: Lanes, knot: int, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Set the turning rates to the next knot, and note how far shaft, cage and ball spin will move in ``moves``."""
    wide()
    params, drive, state, slow = lanes.params, lanes.drive, lanes.state, lanes.slow
    slopes = slow[slow_rows(shape) * LANES :]
    half, per_second = 0.5 / n_steps, 1 / (n_steps * dt) ** 2
    scheduled = min(knot, len(lanes.schedule) - 1)
    for lane in range(lane_count()):
        speed = 1 + fma(0.5, slopes[SPEED * LANES + lane], slow[SPEED * LANES + lane])
        slip = drive[MEAN_SLIP * LANES + lane] + fma(0.5, slopes[SLIP * LANES + lane], slow[SLIP * LANES + lane])
        wander = 1 + fma(0.5, slopes[WANDER * LANES + lane], slow[WANDER * LANES + lane])
        shaft = drive[SHAFT_STEP * LANES + lane] * speed
        if scheduled >= 0:
            shaft *= lanes.schedule[scheduled, 0, lane]
        cage = drive[CAGE_RATIO * LANES + lane] * shaft * (1 - slip)
        quickening = shaft - moves[SHAFT * LANES + lane] if knot > 0 else 0.0
        moves[SHAFT * LANES + lane] = shaft
        moves[CAGE * LANES + lane] = cage
        moves[SPIN * LANES + lane] = drive[SPIN_RATIO * LANES + lane] * shaft * wander
        params[CAGE_TURN_C * LANES + lane], params[CAGE_TURN_S * LANES + lane] = cosine(cage * half), sine(cage * half)
        params[SHAFT_TURN_C * LANES + lane], params[SHAFT_TURN_S * LANES + lane] = (
            cosine(shaft * half),
            sine(shaft * half),
        )
        moment = drive[UNBALANCE * LANES + lane] * per_second
        params[UNBALANCE_P * LANES + lane] = fma(moment * shaft, shaft, drive[BOW * LANES + lane])
        params[UNBALANCE_Q * LANES + lane] = moment * quickening
    # a phasor turned 1e5 times keeps its angle to 1e-13, its length needs help
    for row in (CAGE_C, SHAFT_C):
        direction = state[row * LANES :]
        for lane in range(lane_count()):
            c, s = direction[lane], direction[LANES + lane]
            stretch = 1.5 - 0.5 * fma(c, c, s * s)
            direction[lane], direction[LANES + lane] = c * stretch, s * stretch


@njit(**INLINE)
def keep_turning(shape: Shape, lanes: Lanes, moves: FloatArray) -> None:
    """Take angles and processes to the next knot."""
    wide()
    for i in range(ANGLE_ROWS * lane_count()):
        lanes.angles[i] += moves[i]
    slopes = lanes.slow[slow_rows(shape) * LANES :]
    for i in range(slopes.size):
        lanes.slow[i] += slopes[i]


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
def knock(lanes: Lanes, knot_seconds: float, ahead: int, lane: int, moves: FloatArray) -> float:
    """Force of the cage's knock on the housing, ``ahead`` knots from now: a half sine once per turn of the cage [N].

    The force runs straight from knot to knot and gives the momentum of the half sine however far apart the knots are. Its
    strength scatters from turn to turn, log-normally.
    """
    turned = lanes.angles[CAGE * LANES + lane] - lanes.drive[KNOCK_ANGLE * LANES + lane]
    turned += ahead * moves[CAGE * LANES + lane]
    turns = math.floor(turned / (2 * math.pi) + 0.5)
    since = (turned - 2 * math.pi * turns) * knot_seconds / moves[CAGE * LANES + lane]
    if not -knot_seconds < since < KNOCK_SECONDS + knot_seconds:  # so is what a cage at a standstill gives
        return 0.0
    there = pushed(since + knot_seconds) - 2 * pushed(since) + pushed(since - knot_seconds)
    scatter = math.exp(KNOCK_SCATTER * standard_normal(turns, lanes.drive[KNOCK_SEED * LANES + lane]))
    return lanes.drive[KNOCK * LANES + lane] * scatter * there / knot_seconds**2


@njit(**INLINE)
def outer_forces(lanes: Lanes, knot: int, knot_seconds: float, ahead: int, moves: FloatArray, out: FloatArray) -> None:
    """Forces on shaft and housing ``ahead`` knots from now, x and y of the shaft, then of the housing, into the rows of ``out`` [N].

    Misalignment pulls to and fro along its own direction, and most when the shaft's mark points that way or the opposite one.
    """
    wide()
    drive, state = lanes.drive, lanes.state
    scheduled = min(knot + ahead, len(lanes.schedule) - 1)
    for lane in range(lane_count()):
        load = 1.0
        if scheduled >= 0:
            load = lanes.schedule[scheduled, 1, lane]
        turn = ahead * moves[SHAFT * LANES + lane]
        dc, ds = cosine(turn), sine(turn)
        c, s = state[SHAFT_C * LANES + lane], state[SHAFT_S * LANES + lane]
        c, s = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)
        pull = (c * c - s * s) * drive[TWICE_C * LANES + lane] + 2 * c * s * drive[TWICE_S * LANES + lane]
        out[lane] = fma(load, drive[LOAD_X * LANES + lane], pull * drive[TWICE_X * LANES + lane])
        out[LANES + lane] = fma(load, drive[LOAD_Y * LANES + lane], pull * drive[TWICE_Y * LANES + lane])
    for lane in range(lane_count()):
        hit, place = 0.0, drive[KNOCK_ANGLE * LANES + lane]
        if drive[KNOCK * LANES + lane] != 0.0:
            hit = knock(lanes, knot_seconds, ahead, lane, moves)
        out[2 * LANES + lane] = hit * math.cos(place) if hit != 0.0 else 0.0
        out[3 * LANES + lane] = hit * math.sin(place) if hit != 0.0 else 0.0


@njit(**INLINE)
def move_forces(lanes: Lanes, knot: int, n_steps: int, dt: float, moves: FloatArray, work: FloatArray) -> None:
    """Let the outer forces run from now to their values at the next knot; ``work`` has eight rows."""
    wide()
    for ahead in range(2):
        outer_forces(lanes, knot, n_steps * dt, ahead, moves, work[4 * ahead * LANES :])
    for i in range(4 * lane_count()):
        lanes.params[FORCES * LANES + i] = work[i]
        lanes.params[(FORCES + 4) * LANES + i] = (work[4 * LANES + i] - work[i]) * (0.5 / n_steps)
