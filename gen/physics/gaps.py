"""The gap under every ball at every half step: clearance, waviness of the races, and what spalls take away.

Race waviness is a Fourier series; the sum over its orders is folded onto the balls, since ball ``i`` sees order ``n`` with the phase
``2 pi i n / n_balls``. Each ball has even orders of its own. A spall widens the gap of each ball that passes it; a ball over several
spalls drops by all of them.
"""

import math

import numpy as np
from numba import njit

from gen.physics.kernel import CAGE_C, CAGE_S, COS, SHAFT_C, SHAFT_S, SIN, FloatArray, Shape, gap_row, jitter_row
from gen.physics.lanes import INLINE, LANES, UNFUSED, cosine, sine
from gen.physics.motion import (
    ARC,
    AXIS_FIRST,
    AXIS_LIMIT,
    AXIS_OFFSET,
    AXIS_RMS,
    AXIS_TERMS,
    BALL,
    BALL_ORDERS,
    BALL_SITE,
    CAGE,
    CARRIER,
    CLEARANCE,
    DEPTH,
    HALF,
    INNER,
    INNER_RADIUS,
    LOWEST_ORDER,
    N_ORDERS,
    NO_SITE,
    OUTER_RADIUS,
    POSITION,
    PROFILE,
    SHAFT,
    SITE,
    SPALL_ROWS,
    SPIN,
    TABLE_POINTS,
    TABLE_ROW,
    WAVE_ROWS,
    Lanes,
    process,
    wrapped,
)  # fmt: skip
from gen.physics.spall import TABLE, drop


@njit(**UNFUSED)
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


@njit(**UNFUSED)
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


@njit(**UNFUSED)
def add_ball_waviness(lanes: Lanes, n_balls: int, moves: FloatArray, w: FloatArray) -> None:
    """Add what the balls' own waviness gives at both their contacts at the next knot; all balls spin alike [m]."""
    waves = lanes.waves
    c, s = np.empty(LANES), np.empty(LANES)
    for lane in range(LANES):
        twice = 2 * (lanes.angles[SPIN * LANES + lane] + moves[SPIN * LANES + lane])
        c[lane], s[lane] = math.cos(twice), math.sin(twice)
    zc, zs = c.copy(), s.copy()
    width = n_balls * LANES
    for order in range(BALL_ORDERS):
        row = WAVE_ROWS * LANES + 2 * order * width
        for ball in range(n_balls):
            for lane in range(LANES):
                i = ball * LANES + lane
                w[i] += waves[row + i] * zc[lane] - waves[row + width + i] * zs[lane]
        for lane in range(LANES):
            zr, zi = zc[lane], zs[lane]
            zc[lane], zs[lane] = zr * c[lane] - zi * s[lane], zi * c[lane] + zr * s[lane]


@njit(**UNFUSED)
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
        if lanes.waves.size > WAVE_ROWS * LANES:
            add_ball_waviness(lanes, n_balls, moves, gaps)
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


@njit(**INLINE)
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
                # a ball may leave its place by as much as the space between two
                around = min(int(half / pitch + (1.5 if len(shape.jittered) else 0.7)), n_balls // 2)
                for rank in range(-around, n_balls - around if 2 * around >= n_balls else around + 1):
                    offset, rate = (nearest + rank) * pitch - start, -slope / (2 * n_steps)
                    ball = int((nearest + rank) % n_balls)
                    if len(shape.jittered):
                        source = jitter_row(shape) + 2 * ball
                        offset += params[source * LANES + lane]
                        rate += params[(source + 1) * LANES + lane]
                    gap = (gap_row(shape) + ball) * LANES + lane
                    pass_spall(lanes, spall, lane, gap, stride, offset, rate, 1.0, race, n_steps)
