"""The gap under every ball at every half step: clearance, waviness of the races, and what spalls take away.

Race waviness is a Fourier series; ball ``i`` sees order ``n`` with the phase ``2 pi i n / n_balls``, so all orders that differ by the
number of balls go together: as many sums as there are balls, each by Horner's rule, and one Fourier transform from sums to balls. Each
ball has even orders of its own. A spall widens the gap of each ball that passes it; a ball over several spalls drops by all of them.
"""

import math

import numpy as np
from numba import njit

from gen.physics.kernel.compiling import INLINE, LANES, cosine, fma, lane_count, sine, wide
from gen.physics.kernel.drop import GEOMETRIC, RECTANGULAR, TABLE, drop
from gen.physics.kernel.equations import (
    CAGE_C,
    CAGE_S,
    MAX_BALLS,
    SHAFT_C,
    SHAFT_S,
    FloatArray,
    Shape,
    drop_row,
    gap_row,
)
from gen.physics.kernel.turning import (
    ARC,
    AXIS_LIMIT,
    AXIS_OFFSET,
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
    JITTER,
    OUTER_RADIUS,
    PERIOD,
    POSITION,
    PROFILE,
    REACH,
    SHAFT,
    SITE,
    SPALL_ROWS,
    SPIN,
    TABLE_POINTS,
    TABLE_ROW,
    TILT,
    WITH_CAGE,
    WITH_SHAFT,
    WITH_SPIN,
    Lanes,
    n_terms,
    race_rows,
    slow_rows,
)  # fmt: skip

_TURNS = np.arange(MAX_BALLS)[:, None] * np.arange(MAX_BALLS) / np.maximum(np.arange(MAX_BALLS + 1), 1)[:, None, None]
COS_OF_TURNS, SIN_OF_TURNS = np.cos(2 * np.pi * _TURNS), np.sin(2 * np.pi * _TURNS)  # (number of balls, ball, order)
SIN_OF_TURNS[2 * np.arange(MAX_BALLS // 2 + 1), :, np.arange(MAX_BALLS // 2 + 1) % MAX_BALLS] = (
    0.0  # of half the number of balls
)
DIRECTION, POWER, TURN, N_ROTATIONS = range(4)  # complex numbers of the work array of the waviness, two rows each


@njit(**INLINE)
def start_rotation(shape: Shape, z: FloatArray) -> None:
    """Set ``TURN`` to 1 and ``POWER`` to the direction to the power of the number of balls."""
    wide()
    for lane in range(lane_count()):
        c, s = z[lane], z[LANES + lane]
        p, q = c, s
        for _ in range(len(shape.balls) - 1):
            p, q = fma(p, c, -(q * s)), fma(p, s, q * c)
        z[2 * POWER * LANES + lane], z[(2 * POWER + 1) * LANES + lane] = p, q
        z[2 * TURN * LANES + lane], z[(2 * TURN + 1) * LANES + lane] = 1.0, 0.0


@njit(**INLINE)
def fold_waviness(shape: Shape, waves: FloatArray, z: FloatArray, folded: FloatArray) -> None:
    """Add the waviness of one race, turned to the direction in ``z``, to the complex amplitudes in ``folded``, two rows for each ball."""
    wide()
    n_balls = len(shape.balls)
    start_rotation(shape, z)
    for first in range(n_balls):
        amplitudes, sums = waves[2 * first * LANES :], folded[2 * first * LANES :]
        for lane in range(lane_count()):
            c, s = z[2 * POWER * LANES + lane], z[(2 * POWER + 1) * LANES + lane]
            real = imag = 0.0
            for term in range(n_terms(shape)):
                row = 2 * (n_terms(shape) - 1 - term) * n_balls * LANES + lane
                real, imag = (
                    fma(real, c, fma(-imag, s, amplitudes[row])), fma(real, s, fma(imag, c, amplitudes[row + LANES])),
                )  # fmt: skip
            c, s = z[2 * TURN * LANES + lane], z[(2 * TURN + 1) * LANES + lane]
            sums[lane] += fma(real, c, -(imag * s))
            sums[LANES + lane] += fma(real, s, imag * c)
            p, q = z[2 * DIRECTION * LANES + lane], z[(2 * DIRECTION + 1) * LANES + lane]
            z[2 * TURN * LANES + lane], z[(2 * TURN + 1) * LANES + lane] = fma(c, p, -(s * q)), fma(c, q, s * p)


@njit(**INLINE)
def unfold(shape: Shape, folded: FloatArray, gaps: FloatArray) -> None:
    """Take the real part of the Fourier transform of ``folded``, one value per ball, from ``gaps``.

    Balls ``i`` and ``n - i`` share their sums.
    """
    wide()
    n_balls = len(shape.balls)
    for lane in range(lane_count()):
        for order in range(1, (n_balls + 1) // 2):
            low, high = 2 * order * LANES + lane, 2 * (n_balls - order) * LANES + lane
            folded[low] += folded[high]
            folded[low + LANES] -= folded[high + LANES]
    for ball in range(n_balls // 2 + 1):
        here, mirror = gaps[ball * LANES :], gaps[(n_balls - ball) % n_balls * LANES :]
        other = 1.0 if ball < n_balls - ball < n_balls else 0.0
        cosines, sines = COS_OF_TURNS[n_balls, ball], SIN_OF_TURNS[n_balls, ball]
        for lane in range(lane_count()):
            even, odd = folded[lane], 0.0
            for order in range(1, n_balls // 2 + 1):
                even = fma(folded[2 * order * LANES + lane], cosines[order], even)
                odd = fma(folded[(2 * order + 1) * LANES + lane], sines[order], odd)
            here[lane] -= even - odd
            mirror[lane] -= other * (even + odd)


@njit(**INLINE)
def take_ball_waviness(shape: Shape, lanes: Lanes, moves: FloatArray, z: FloatArray, gaps: FloatArray) -> None:
    """Take what the balls' own waviness gives at both their contacts at the next knot from ``gaps``; all balls spin alike."""
    wide()
    n_balls = len(shape.balls)
    for lane in range(lane_count()):
        twice = 2 * (lanes.angles[SPIN * LANES + lane] + moves[SPIN * LANES + lane])
        z[lane], z[LANES + lane] = math.cos(twice), math.sin(twice)
    for ball in range(n_balls):
        waves, here = lanes.waves[(race_rows(shape) + 2 * ball) * LANES :], gaps[ball * LANES :]
        for lane in range(lane_count()):
            c, s = z[lane], z[LANES + lane]
            real = imag = 0.0
            for order in range(BALL_ORDERS):
                row = 2 * (BALL_ORDERS - 1 - order) * n_balls * LANES + lane
                real, imag = fma(real, c, fma(-imag, s, waves[row])), fma(real, s, fma(imag, c, waves[row + LANES]))
            here[lane] -= fma(real, c, -(imag * s))


@njit(**INLINE)
def ball_gaps(shape: Shape, lanes: Lanes, moves: FloatArray, work: FloatArray, gaps: FloatArray) -> None:
    """Gap of every ball at the next knot, waviness included and spalls aside, into ``gaps`` (ball * LANES + lane) [m].

    ``work`` has two rows for each ball and two for each of the rotations.
    """
    wide()
    state, n_balls = lanes.state, len(shape.balls)
    for lane in range(lane_count()):
        for ball in range(n_balls):
            gaps[ball * LANES + lane] = lanes.drive[CLEARANCE * LANES + lane]
    z, folded = work, work[2 * N_ROTATIONS * LANES :]
    for lane in range(lane_count()):
        for row in range(2 * n_balls):
            folded[row * LANES + lane] = 0.0
    for race in range(2):
        for lane in range(lane_count()):
            c, s = state[CAGE_C * LANES + lane], state[CAGE_S * LANES + lane]
            dc, ds = cosine(moves[CAGE * LANES + lane]), sine(moves[CAGE * LANES + lane])
            c, s = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)
            if race == 0:
                p, q = state[SHAFT_C * LANES + lane], state[SHAFT_S * LANES + lane]
                dc, ds = cosine(moves[SHAFT * LANES + lane]), sine(moves[SHAFT * LANES + lane])
                p, q = fma(p, dc, -(q * ds)), fma(q, dc, p * ds)
                c, s = fma(c, p, s * q), fma(s, p, -(c * q))
            z[2 * DIRECTION * LANES + lane], z[(2 * DIRECTION + 1) * LANES + lane] = c, s
        fold_waviness(shape, lanes.waves[race * (race_rows(shape) // 2) * LANES :], z, folded)
    unfold(shape, folded, gaps)
    if lanes.waves.size > race_rows(shape) * LANES:
        take_ball_waviness(shape, lanes, moves, z, gaps)


@njit(**INLINE)
def move_gaps(
    shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray, work: FloatArray, next_gaps: FloatArray
) -> None:
    """Let the gap of every ball run straight to its value at the next knot; ``next_gaps`` holds those at this one."""
    wide()
    gaps, per_half_step = lanes.params[gap_row(shape) * LANES :], 0.5 / n_steps
    for lane in range(lane_count()):
        for ball in range(len(shape.balls)):
            gaps[2 * ball * LANES + lane] = next_gaps[ball * LANES + lane]
    ball_gaps(shape, lanes, moves, work, next_gaps)
    for lane in range(lane_count()):
        for ball in range(len(shape.balls)):
            further = next_gaps[ball * LANES + lane] - gaps[2 * ball * LANES + lane]
            gaps[(2 * ball + 1) * LANES + lane] = further * per_half_step


@njit(**INLINE)
def share_on_track(shape: Shape, lanes: Lanes, lane: int) -> float:
    """Share of its drop that a ball spall gives while the spin axis leaves it off the track, 1 if it never does [1]."""
    limit = lanes.drive[AXIS_LIMIT * LANES + lane]
    if limit <= 0.0:
        return 1.0
    slope = lanes.slow[(slow_rows(shape) + TILT) * LANES + lane]
    tilt = lanes.drive[AXIS_OFFSET * LANES + lane] + lanes.slow[TILT * LANES + lane] + slope
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
    shape: Shape, lanes: Lanes, spall: int, lane: int, ball: int, start: float, slope: float, share: float, race: float, n_steps: int,
    falls: FloatArray,
) -> None:  # fmt: skip
    """Let a ball drop while it passes a spall, from offset ``start`` at ``slope`` per half step, at every half step."""
    wide()
    this = lanes.spalls[spall * SPALL_ROWS * LANES :]
    half, n_half_steps = this[HALF * LANES + lane], 2 * n_steps + 1
    end = start + 2 * n_steps * slope
    if min(start, end) >= half or max(start, end) <= -half:
        return
    arc, depth, radius = this[ARC * LANES + lane], this[DEPTH * LANES + lane], lanes.drive[BALL * LANES + lane]
    profile, table = int(this[PROFILE * LANES + lane]), int(this[TABLE_ROW * LANES + lane])
    if this[SITE * LANES + lane] == BALL_SITE and race < 0.0:
        table += 1
    if profile == TABLE:
        for half_step in range(n_half_steps):
            falls[half_step] = tabulated(lanes.tables, table, fma(slope, half_step, start), half)
    elif profile == RECTANGULAR:
        for half_step in range(n_half_steps):
            falls[half_step] = depth if abs(fma(slope, half_step, start)) < half else 0.0
    elif profile == GEOMETRIC:
        for half_step in range(n_half_steps):
            falls[half_step] = drop(GEOMETRIC, fma(slope, half_step, start), half, arc, radius, race, depth)
    else:
        for half_step in range(n_half_steps):
            falls[half_step] = drop(profile, fma(slope, half_step, start), half, arc, radius, race, depth)
    drops = lanes.params[(drop_row(shape) + ball) * LANES + lane :]
    for half_step in range(n_half_steps):
        drops[half_step * len(shape.balls) * LANES] += share * falls[half_step]


@njit(**INLINE)
def meet_spall(
    shape: Shape, lanes: Lanes, spall: int, lane: int, n_steps: int, start: float, slope: float, falls: FloatArray
) -> None:
    """Let the balls that meet a spall drop; ball 0, or the track of a ball spall, is at ``start`` from it and moves by ``slope``."""
    n_balls, rate = len(shape.balls), slope / (2 * n_steps)
    this = lanes.spalls[spall * SPALL_ROWS * LANES :]
    site, period = this[SITE * LANES + lane], this[PERIOD * LANES + lane]
    nearest = np.int64(np.rint((start + 0.5 * slope) / period))
    inner, outer = lanes.drive[INNER_RADIUS * LANES + lane], -lanes.drive[OUTER_RADIUS * LANES + lane]
    if site == BALL_SITE:
        race, ball = inner if nearest & 1 == 0 else outer, int(this[CARRIER * LANES + lane])
        share = share_on_track(shape, lanes, lane)
        pass_spall(shape, lanes, spall, lane, ball, start - nearest * period, rate, share, race, n_steps, falls)
        return
    race = inner if site == INNER else outer
    reach = this[REACH * LANES + lane] + 0.5 * abs(slope)
    around = min(int(reach / period + 0.5), n_balls // 2)
    for rank in range(-around, n_balls - around if 2 * around >= n_balls else around + 1):
        ball = int((rank - nearest) % n_balls)
        offset, passing = start + (rank - nearest) * period, rate
        if len(shape.jittered):
            source = (JITTER + ball) * LANES + lane
            offset += lanes.slow[source]
            passing += lanes.slow[slow_rows(shape) * LANES + source] / (2 * n_steps)
        pass_spall(shape, lanes, spall, lane, ball, offset, passing, 1.0, race, n_steps, falls)


@njit(**INLINE)
def move_spalls(
    shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray, work: FloatArray, dropped: FloatArray
) -> None:
    """Let every ball that meets a spall before the next knot drop.

    ``work`` has four rows and room for all half steps; ``dropped`` is 1 in its first place if drops of the last knot are to be cleared.
    """
    wide()
    if dropped[0] > 0.0:
        drops = lanes.params[drop_row(shape) * LANES :]
        for i in range((2 * n_steps + 1) * len(shape.balls) * lane_count()):
            drops[i] = 0.0
        dropped[0] = 0.0
    angles, starts, slopes, near, falls = lanes.angles, 0, LANES, 2 * LANES, work[3 * LANES :]
    for spall in range(lanes.spalls.size // (SPALL_ROWS * LANES)):
        this = lanes.spalls[spall * SPALL_ROWS * LANES :]
        for lane in range(lane_count()):
            with_cage, with_shaft = this[WITH_CAGE * LANES + lane], this[WITH_SHAFT * LANES + lane]
            with_spin, period = this[WITH_SPIN * LANES + lane], this[PERIOD * LANES + lane]
            start = with_cage * angles[CAGE * LANES + lane] + with_shaft * angles[SHAFT * LANES + lane]
            start += with_spin * angles[SPIN * LANES + lane] + this[POSITION * LANES + lane]
            slope = with_cage * moves[CAGE * LANES + lane] + with_shaft * moves[SHAFT * LANES + lane]
            slope += with_spin * moves[SPIN * LANES + lane]
            middle = start + 0.5 * slope
            away = abs(middle - period * np.rint(middle / period)) - 0.5 * abs(slope)
            work[starts + lane], work[slopes + lane] = start, slope
            work[near + lane] = 1.0 if away < this[REACH * LANES + lane] else 0.0
        for lane in range(lane_count()):
            if work[near + lane] > 0.0:
                meet_spall(shape, lanes, spall, lane, n_steps, work[starts + lane], work[slopes + lane], falls)
                dropped[0] = 1.0
