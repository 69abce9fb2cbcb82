"""From one knot to the next: how shaft, cage, balls and spalls move while the kernel takes its steps.

Speed, slip, spin, jitter and spin-axis wander are sums of a few cosines with drawn frequencies and phases; each cosine is a phasor
turned once per knot, so no process needs a table in memory and none depends on the step. Race waviness is a Fourier series too: the
sum over orders is folded onto the balls, since ball ``i`` sees order ``n`` with the phase ``2 pi i n / n_balls``. What a spall takes
from under a ball is laid down for every half step, so that the kernel itself knows gaps alone.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.kernel import (
    CAGE_C,
    CAGE_S,
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
    gap_row,
    jitter_row,
)  # fmt: skip
from gen.physics.lanes import COMPILED, INLINE, LANES, cosine, sine
from gen.physics.spall import TABLE, drop

# Rows of ``drive``: what a record's motion is made of.
(
    SHAFT_STEP, CAGE_RATIO, SPIN_RATIO, MEAN_SLIP, SPEED_RMS, SLIP_RMS, SPIN_RMS, JITTER_RMS, AXIS_OFFSET, AXIS_RMS, AXIS_LIMIT,
    UNBALANCE, CLEARANCE, BALL, INNER_RADIUS, OUTER_RADIUS, LOAD_X, LOAD_Y, TWICE_X, TWICE_Y, BOW, KNOCK, KNOCK_ANGLE, LATE_BALL, LATE_BY,
    DRIVE_ROWS,
) = range(26)  # fmt: skip
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
TABLE_POINTS = 513  # of a tabulated spall, from edge to edge
KNOCK_SECONDS = 3e-4  # a half sine


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
    """Waviness amplitudes [m], WAVE_ROWS rows, or empty."""
    schedule: FloatArray
    """Factors of shaft rate and load, shape (knot, 2, lane), or of shape (0, 2, lane) if both are constant."""
    tables: FloatArray
    """Drops of tabulated spalls, shape (table, point) [m]; a ball spall has two, for the inner and the outer race."""


@njit(**INLINE)
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


@njit(**INLINE)
def turn_rings(lanes: Lanes, knot: int, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Set the turning rates to the next knot, and note how far shaft, cage and ball spin will move in ``moves``."""
    params, drive, phasors, state = lanes.params, lanes.drive, lanes.phasors, lanes.state
    for lane in range(LANES):
        speed = 1 + drive[SPEED_RMS * LANES + lane] * process(phasors, 0, SPEED_TERMS, lane)
        shaft = drive[SHAFT_STEP * LANES + lane] * speed
        if knot < len(lanes.schedule):
            shaft *= lanes.schedule[knot, 0, lane]
        slip = drive[MEAN_SLIP * LANES + lane] + drive[SLIP_RMS * LANES + lane] * process(
            phasors, SLIP_FIRST, SLIP_TERMS, lane
        )
        cage = drive[CAGE_RATIO * LANES + lane] * shaft * (1 - slip)
        wander = 1 + drive[SPIN_RMS * LANES + lane] * process(phasors, SPIN_FIRST, SPIN_TERMS, lane)
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
        omega = shaft / (n_steps * dt)
        params[UNBALANCE_P * LANES + lane] = drive[UNBALANCE * LANES + lane] * omega * omega + drive[BOW * LANES + lane]
        params[UNBALANCE_Q * LANES + lane] = 0.0
        for row in (
            CAGE_C,
            SHAFT_C,
        ):  # a phasor turned 1e5 times keeps its angle to 1e-13, its length needs help
            c, s = state[row * LANES + lane], state[(row + 1) * LANES + lane]
            stretch = 1.5 - 0.5 * (c * c + s * s)
            state[row * LANES + lane], state[(row + 1) * LANES + lane] = c * stretch, s * stretch


@njit(**INLINE)
def fold_waviness(lanes: Lanes, n_balls: int, race: int, c: FloatArray, s: FloatArray, folded: FloatArray) -> None:
    """Add the waviness of one race, turned to direction ``c, s``, to the ``n_balls`` complex amplitudes in ``folded``."""
    waves = lanes.waves
    zc, zs = np.empty(LANES), np.empty(LANES)
    for lane in range(LANES):
        zc[lane] = c[lane] * c[lane] - s[lane] * s[lane]
        zs[lane] = 2 * c[lane] * s[lane]
    for order in range(N_ORDERS):
        row = (2 * race * N_ORDERS + order) * LANES
        bin_ = ((order + LOWEST_ORDER) % n_balls) * LANES
        for lane in range(LANES):
            real, imag = waves[row + lane], waves[row + N_ORDERS * LANES + lane]
            zr, zi = zc[lane], zs[lane]
            folded[bin_ + lane] += real * zr - imag * zi
            folded[n_balls * LANES + bin_ + lane] += real * zi + imag * zr
            zc[lane] = zr * c[lane] - zi * s[lane]
            zs[lane] = zi * c[lane] + zr * s[lane]


@njit(**INLINE)
def waviness(
    lanes: Lanes,
    n_balls: int,
    cage_c: FloatArray,
    cage_s: FloatArray,
    in_c: FloatArray,
    in_s: FloatArray,
    w: FloatArray,
) -> None:
    """Waviness under every ball, both races together, into ``w`` (ball * LANES + lane) [m]."""
    folded = np.zeros(2 * n_balls * LANES)
    fold_waviness(lanes, n_balls, 0, in_c, in_s, folded)
    fold_waviness(lanes, n_balls, 1, cage_c, cage_s, folded)
    for ball in range(n_balls):
        for lane in range(LANES):
            w[ball * LANES + lane] = 0.0
        for order in range(n_balls):
            turn = (ball * order) % n_balls
            for lane in range(LANES):
                real, imag = folded[order * LANES + lane], folded[(n_balls + order) * LANES + lane]
                w[ball * LANES + lane] += real * COS[n_balls, turn] - imag * SIN[n_balls, turn]


@njit(**INLINE)
def ball_gaps(lanes: Lanes, n_balls: int, moves: FloatArray, gaps: FloatArray) -> None:
    """Gap of every ball at the next knot, waviness included and spalls aside, into ``gaps`` (ball * LANES + lane) [m]."""
    state = lanes.state
    if lanes.waves.size:
        cage_c, cage_s, in_c, in_s = np.empty(LANES), np.empty(LANES), np.empty(LANES), np.empty(LANES)
        for lane in range(LANES):
            c, s = state[CAGE_C * LANES + lane], state[CAGE_S * LANES + lane]
            dc, ds = cosine(moves[CAGE * LANES + lane]), sine(moves[CAGE * LANES + lane])
            c, s = c * dc - s * ds, s * dc + c * ds
            p, q = state[SHAFT_C * LANES + lane], state[SHAFT_S * LANES + lane]
            dc, ds = cosine(moves[SHAFT * LANES + lane]), sine(moves[SHAFT * LANES + lane])
            p, q = p * dc - q * ds, q * dc + p * ds
            cage_c[lane], cage_s[lane] = c, s
            in_c[lane], in_s[lane] = c * p + s * q, s * p - c * q
        waviness(lanes, n_balls, cage_c, cage_s, in_c, in_s, gaps)
    else:
        gaps[:] = 0.0
    for ball in range(n_balls):
        for lane in range(LANES):
            gaps[ball * LANES + lane] = lanes.drive[CLEARANCE * LANES + lane] - gaps[ball * LANES + lane]


@njit(**INLINE)
def move_gaps(shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray, last: FloatArray, gaps: FloatArray) -> None:
    """Lay down the gap of every ball at every half step: a straight line from ``last`` to its value at the next knot."""
    n_balls = len(shape.balls)
    ball_gaps(lanes, n_balls, moves, gaps)
    row = gap_row(shape) * LANES
    width = n_balls * LANES
    for half_step in range(2 * n_steps + 1):
        part = half_step / (2 * n_steps)
        for i in range(width):
            lanes.params[row + half_step * width + i] = last[i] + part * (gaps[i] - last[i])
    last[:] = gaps


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
def share_on_track(lanes: Lanes, lane: int) -> float:
    """Share of its drop that a ball spall gives while the spin axis leaves it off the track, 1 if it never does [1]."""
    limit = lanes.drive[AXIS_LIMIT * LANES + lane]
    if limit <= 0.0:
        return 1.0
    tilt = lanes.drive[AXIS_OFFSET * LANES + lane]
    tilt += lanes.drive[AXIS_RMS * LANES + lane] * process(lanes.phasors, AXIS_FIRST, AXIS_TERMS, lane)
    return max(0.0, 1 - (tilt / limit) ** 2)


@njit(**INLINE)
def tabulated(tables: FloatArray, row: int, offset: float, half: float) -> float:
    """Drop read from a table that runs from edge to edge of the spall, linear between its points [m]."""
    if abs(offset) >= half:
        return 0.0
    place = (offset / half + 1) * 0.5 * (TABLE_POINTS - 1)
    point = min(int(place), TABLE_POINTS - 2)
    part = place - point
    return (1 - part) * tables[row, point] + part * tables[row, point + 1]


@njit(**COMPILED)
def pass_spall(
    lanes: Lanes,
    spall: int,
    lane: int,
    gap: int,
    stride: int,
    start: float,
    slope: float,
    share: float,
    race: float,
    n_steps: int,
) -> None:
    """Widen a gap while a ball passes a spall, from offset ``start`` at ``slope`` per half step, at every half step."""
    spalls = lanes.spalls
    row = spall * SPALL_ROWS
    half = spalls[(row + HALF) * LANES + lane]
    end = start + 2 * n_steps * slope
    if min(start, end) >= half or max(start, end) <= -half:
        return
    arc, depth = spalls[(row + ARC) * LANES + lane], spalls[(row + DEPTH) * LANES + lane]
    profile = int(spalls[(row + PROFILE) * LANES + lane])
    table = int(spalls[(row + TABLE_ROW) * LANES + lane])
    if spalls[(row + SITE) * LANES + lane] == BALL_SITE and race < 0.0:
        table += 1
    ball = lanes.drive[BALL * LANES + lane]
    for half_step in range(2 * n_steps + 1):
        offset = start + slope * half_step
        fall = (
            tabulated(lanes.tables, table, offset, half)
            if profile == TABLE
            else drop(profile, offset, half, arc, ball, race, depth)
        )
        lanes.params[gap + half_step * stride] += share * fall


@njit(**INLINE)
def move_spalls(shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray) -> None:
    """Widen the gaps over every spall that a ball meets before the next knot."""
    n_balls = len(shape.balls)
    pitch = 2 * math.pi / n_balls
    params, angles, spalls = lanes.params, lanes.angles, lanes.spalls
    stride = n_balls * LANES
    for spall in range(spalls.size // (SPALL_ROWS * LANES)):
        row = spall * SPALL_ROWS
        for lane in range(LANES):
            site = spalls[(row + SITE) * LANES + lane]
            place = spalls[(row + POSITION) * LANES + lane]
            if site == BALL_SITE:
                ball = int(spalls[(row + CARRIER) * LANES + lane])
                slope = moves[SPIN * LANES + lane]
                middle = wrapped(angles[SPIN * LANES + lane] + place + 0.5 * slope)
                inner = abs(middle) < 0.5 * math.pi
                race = lanes.drive[INNER_RADIUS * LANES + lane] if inner else -lanes.drive[OUTER_RADIUS * LANES + lane]
                start = (middle if inner else wrapped(middle - math.pi)) - 0.5 * slope
                gap = (gap_row(shape) + ball) * LANES + lane
                share = share_on_track(lanes, lane)
                pass_spall(lanes, spall, lane, gap, stride, start, slope / (2 * n_steps), share, race, n_steps)
            elif site != NO_SITE:
                start, slope = place - angles[CAGE * LANES + lane], -moves[CAGE * LANES + lane]
                race = -lanes.drive[OUTER_RADIUS * LANES + lane]
                if site == INNER:
                    start += angles[SHAFT * LANES + lane]
                    slope += moves[SHAFT * LANES + lane]
                    race = lanes.drive[INNER_RADIUS * LANES + lane]
                half = spalls[(row + HALF) * LANES + lane]
                nearest = np.rint((start + 0.5 * slope) / pitch)
                around = int(half / pitch + 0.7)  # 0.2 more than it takes, for jitter and a late ball
                for rank in range(-around, around + 1):
                    offset, rate = (nearest + rank) * pitch - start, -slope / (2 * n_steps)
                    if abs(offset - 0.5 * slope) > half + 0.5 * abs(slope) + 0.2 * pitch:
                        continue
                    ball = int((nearest + rank) % n_balls)
                    if len(shape.jittered):
                        source = jitter_row(shape) + 2 * ball
                        offset += params[source * LANES + lane]
                        rate += params[(source + 1) * LANES + lane]
                    gap = (gap_row(shape) + ball) * LANES + lane
                    pass_spall(lanes, spall, lane, gap, stride, offset, rate, 1.0, race, n_steps)


@njit(**INLINE)
def knock(lanes: Lanes, knot_seconds: float, ahead: float, lane: int, moves: FloatArray) -> float:
    """Force of the cage's knock on the housing, ``ahead`` knots from now: a half sine once per turn of the cage [N].

    Its strength scatters from turn to turn by a factor between 0.5 and 2 that follows from the number of the turn.
    """
    strength = lanes.drive[KNOCK * LANES + lane]
    if strength == 0.0:
        return 0.0
    rate = moves[CAGE * LANES + lane] / knot_seconds
    turned = (
        lanes.angles[CAGE * LANES + lane] + ahead * moves[CAGE * LANES + lane] - lanes.drive[KNOCK_ANGLE * LANES + lane]
    )
    turns = math.floor(turned / (2 * math.pi))
    since = (turned - 2 * math.pi * turns) / rate
    if since >= KNOCK_SECONDS:
        return 0.0
    scatter = (turns * 0.6180339887498949) % 1.0  # golden ratio: even over few turns
    return strength * 2.0 ** (2 * scatter - 1) * math.sin(math.pi * since / KNOCK_SECONDS)


@njit(**INLINE)
def outer_forces(
    lanes: Lanes, knot: int, knot_seconds: float, ahead: float, lane: int, moves: FloatArray, force: FloatArray
) -> None:
    """Forces on shaft and housing ``ahead`` knots from now, into ``force`` (x and y of the shaft, then of the housing) [N]."""
    drive = lanes.drive
    load = 1.0
    if len(lanes.schedule):
        load = lanes.schedule[min(knot + int(ahead), len(lanes.schedule) - 1), 1, lane]
    turn = 2 * (lanes.angles[SHAFT * LANES + lane] + ahead * moves[SHAFT * LANES + lane])
    c, s = math.cos(turn), math.sin(turn)
    hit, place = knock(lanes, knot_seconds, ahead, lane, moves), drive[KNOCK_ANGLE * LANES + lane]
    force[0] = load * drive[LOAD_X * LANES + lane] + drive[TWICE_X * LANES + lane] * c
    force[1] = load * drive[LOAD_Y * LANES + lane] + drive[TWICE_Y * LANES + lane] * s
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


@njit(**INLINE)
def to_next_knot(
    shape: Shape,
    lanes: Lanes,
    knot: int,
    n_steps: int,
    dt: float,
    moves: FloatArray,
    last: FloatArray,
    gaps: FloatArray,
) -> None:
    """Prepare ``lanes.params`` for the steps up to the next knot, and move the angles there.

    ``last`` holds the gaps at this knot and receives those at the next; ``moves`` and ``gaps`` are work arrays.
    """
    turn_rings(lanes, knot, n_steps, dt, moves)
    turn_phasors(lanes.phasors, JITTER_FIRST + len(shape.balls) * JITTER_TERMS)
    if len(shape.forced):
        move_forces(lanes, knot, n_steps, dt, moves)
    if len(shape.jittered):
        move_jitter(shape, lanes, n_steps)
    if len(shape.uneven):
        move_gaps(shape, lanes, n_steps, moves, last, gaps)
        move_spalls(shape, lanes, n_steps, moves)
    for i in range(ANGLE_ROWS * LANES):
        lanes.angles[i] += moves[i]


@njit(**INLINE)
def place_balls(shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray, last: FloatArray) -> None:
    """Gaps into ``last`` and jitter at the first knot."""
    moves[:] = 0.0
    if len(shape.uneven):
        ball_gaps(lanes, len(shape.balls), moves, last)
    if len(shape.jittered):
        move_jitter(shape, lanes, n_steps)
        for ball in range(len(shape.balls)):
            row = jitter_row(shape) + 2 * ball
            for lane in range(LANES):
                lanes.params[row * LANES + lane] += 2 * n_steps * lanes.params[(row + 1) * LANES + lane]
                lanes.params[(row + 1) * LANES + lane] = 0.0
