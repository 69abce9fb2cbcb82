"""The drop of every ball that passes a spall, at every half step; a ball over several spalls drops by the sum.

The edge of a real spall is jagged, and successive balls meet different points of it: the drops of a spall may have a log-normal scatter
from passage to passage, as the impacts in the model of Antoni and Randall have random amplitudes [1]_. The number of a passage counts the
balls, or the contacts of a damaged ball, that have passed the spall since angle 0.

.. [1] J. Antoni, R. B. Randall, "A stochastic model for simulation and diagnostics of rolling element bearings with localized faults",
       *J. Vib. Acoust.* 125 (2003) 282-289.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.extent import TABLE_POINTS
from gen.physics.kernel.chance import standard_normal, uniform
from gen.physics.kernel.compiling import ALLOCATING, INLINE, LANES, fma, lane_count, wide, zeros
from gen.physics.kernel.drop import GEOMETRIC, RECTANGULAR, TABLE, drop
from gen.physics.kernel.layout import (
    Angle,
    Batch,
    Drive,
    FloatArray,
    Process,
    Shape,
    Site,
    SpallRow,
    drop_row,
    slow_rows,
)

SPALL_ROWS = len(SpallRow)
NEVER = -1e9  # number of a turn before any other


class Passage(NamedTuple):
    """How one ball passes one spall."""

    start: float
    """Offset of the ball from the middle of the spall at the knot [rad]."""
    slope: float
    """Its change per half step [rad]."""
    share: float
    """Factor of the drop [1]."""
    race: float
    """Radius of the race under the ball: positive if convex (inner), negative if concave (outer) [m]."""


@njit(**INLINE)
def jump_axes(batch: Batch) -> None:
    """Let the spin axis of the damaged ball of every lane take a new place, with some probability, where the ball is opposite the load.

    There the races hold the ball least. Tilt and spin angle after a jump are independent normal numbers with the same standard deviation,
    as after a small random rotation of the ball.
    """
    drive = batch.drive
    for lane in range(lane_count(batch.n_records)):
        probability = drive[Drive.AXIS_JUMPS * LANES + lane]
        if probability > 0.0:
            past = batch.angles[Angle.CAGE * LANES + lane] - drive[Drive.AXIS_ANGLE * LANES + lane]
            turn, last = math.floor(past / (2 * math.pi)), drive[Drive.AXIS_TURN * LANES + lane]
            seed, spread = drive[Drive.AXIS_SEED * LANES + lane], drive[Drive.AXIS_SPREAD * LANES + lane]
            if turn != last and (last == NEVER or uniform(8 * turn, seed) < probability):
                # standard_normal(n) takes the uniform numbers 2 n and 2 n + 1
                drive[Drive.AXIS_TILT * LANES + lane] = spread * standard_normal(4 * turn + 1, seed)
                drive[Drive.AXIS_SHIFT * LANES + lane] = spread * standard_normal(4 * turn + 2, seed)
            drive[Drive.AXIS_TURN * LANES + lane] = turn


@njit(**INLINE)
def share_on_track(shape: Shape, batch: Batch, lane: int) -> float:
    """Share of a ball spall that is on the track, which falls to 0 as the spin axis tilts to its limit; 1 without a limit [1]."""
    limit = batch.drive[Drive.AXIS_LIMIT * LANES + lane]
    if limit <= 0.0:
        return 1.0
    slope = batch.slow[(slow_rows(shape) + Process.TILT) * LANES + lane]
    tilt = batch.drive[Drive.AXIS_OFFSET * LANES + lane] + batch.slow[Process.TILT * LANES + lane] + slope
    tilt += batch.drive[Drive.AXIS_TILT * LANES + lane]
    return max(0.0, 1 - (tilt / limit) ** 2)


@njit(**INLINE)
def tabulated(tables: FloatArray, row: int, offset: float, half: float) -> float:
    """Drop from a table of evenly spaced points from edge to edge of the spall, interpolated linearly [m]."""
    if abs(offset) >= half:
        return 0.0
    place = (offset / half + 1) * 0.5 * (TABLE_POINTS - 1)
    point = min(int(place), TABLE_POINTS - 2)
    part = place - point
    return (1 - part) * tables[row, point] + part * tables[row, point + 1]


@njit(**ALLOCATING)
def none_met(shape: Shape, batch: Batch) -> FloatArray:
    """Work array of the spalls: for each ball 1 if it holds drops that are to be cleared.

    Then, spall after spall, the number of the last passage of each lane and the factor of its drop.
    """
    n_balls, n_spalls = shape.balls, batch.spalls.size // (SPALL_ROWS * LANES)
    met = zeros(n_balls + 2 * n_spalls * LANES)
    for i in range(2 * n_spalls * LANES):
        met[n_balls + i] = NEVER
    return met


@njit(**INLINE)
def scatter(spall: FloatArray, lane: int, number: float, last: FloatArray) -> float:
    """Factor of the drop in one passage of a spall, whose rows are ``spall`` [1]; ``last`` keeps that of its last passage."""
    rms = spall[SpallRow.SCATTER * LANES + lane]
    if rms <= 0.0:
        return 1.0
    if last[lane] != number:
        last[lane] = number
        last[LANES + lane] = math.exp(rms * standard_normal(number, spall[SpallRow.SEED * LANES + lane]))
    return last[LANES + lane]


@njit(**INLINE)
def passes(spall: FloatArray, lane: int, start: float, slope: float, n_steps: int) -> bool:
    """Whether a ball is over a spall before the next knot."""
    end, half = start + 2 * n_steps * slope, spall[SpallRow.HALF * LANES + lane]
    return min(start, end) < half and max(start, end) > -half


@njit(**INLINE)
def pass_spall(
    shape: Shape,
    batch: Batch,
    spall: FloatArray,
    lane: int,
    ball: int,
    passage: Passage,
    n_steps: int,
    falls: FloatArray,
    met: FloatArray,
) -> None:
    """Add the drops of one ball over one spall, whose rows are ``spall``, at every half step up to the next knot.

    ``falls`` is a work array.
    """
    wide()
    start, slope, share, race = passage
    n_half_steps = 2 * n_steps + 1
    if not passes(spall, lane, start, slope, n_steps):
        return
    met[ball] = 1.0
    half = spall[SpallRow.HALF * LANES + lane]
    arc, depth = spall[SpallRow.ARC * LANES + lane], spall[SpallRow.DEPTH * LANES + lane]
    radius = batch.drive[Drive.BALL_RADIUS * LANES + lane]
    profile, table = int(spall[SpallRow.PROFILE * LANES + lane]), int(spall[SpallRow.TABLE * LANES + lane])
    if int(spall[SpallRow.SITE * LANES + lane]) == Site.BALL and race < 0.0:
        table += 1
    if profile == TABLE:
        for half_step in range(n_half_steps):
            falls[half_step] = tabulated(batch.tables, table, fma(slope, half_step, start), half)
    elif profile == RECTANGULAR:
        for half_step in range(n_half_steps):
            falls[half_step] = depth if abs(fma(slope, half_step, start)) < half else 0.0
    elif profile == GEOMETRIC:
        for half_step in range(n_half_steps):
            falls[half_step] = drop(GEOMETRIC, fma(slope, half_step, start), half, arc, radius, race, depth)
    else:
        for half_step in range(n_half_steps):
            falls[half_step] = drop(profile, fma(slope, half_step, start), half, arc, radius, race, depth)
    drops = batch.params[(drop_row(shape) + ball) * LANES + lane :]
    for half_step in range(n_half_steps):
        drops[half_step * shape.balls * LANES] += share * falls[half_step]


@njit(**INLINE)
def meet_spall(
    shape: Shape,
    batch: Batch,
    spall: int,
    lane: int,
    n_steps: int,
    start: float,
    slope: float,
    falls: FloatArray,
    met: FloatArray,
) -> None:
    """Add the drops of all balls that meet one spall of one lane before the next knot.

    Ball 0, or for a ball spall the contact with the inner race, is ``start`` past the spall at the knot and moves by ``slope`` to the next
    knot [rad].
    """
    n_balls, rate = shape.balls, slope / (2 * n_steps)
    this = batch.spalls[spall * SPALL_ROWS * LANES :]
    site, period = int(this[SpallRow.SITE * LANES + lane]), this[SpallRow.PERIOD * LANES + lane]
    nearest = np.int64(np.rint((start + 0.5 * slope) / period))
    last = met[n_balls + 2 * spall * LANES :]
    inner, outer = batch.drive[Drive.INNER_RADIUS * LANES + lane], -batch.drive[Drive.OUTER_RADIUS * LANES + lane]
    if site == Site.BALL:
        race, ball = inner if nearest & 1 == 0 else outer, int(this[SpallRow.CARRIER * LANES + lane])
        share = share_on_track(shape, batch, lane) * scatter(this, lane, float(nearest), last)
        passage = Passage(start - nearest * period, rate, share, race)
        pass_spall(shape, batch, this, lane, ball, passage, n_steps, falls, met)
        return
    race = inner if site == Site.INNER else outer
    reach = this[SpallRow.REACH * LANES + lane] + 0.5 * abs(slope)
    around = min(int(reach / period + 0.5), n_balls // 2)
    for rank in range(-around, n_balls - around if 2 * around >= n_balls else around + 1):
        ball = int((rank - nearest) % n_balls)
        offset, passing = start + (rank - nearest) * period, rate
        if shape.jittered:
            source = (Process.JITTER + ball) * LANES + lane
            offset += batch.slow[source]
            passing += batch.slow[slow_rows(shape) * LANES + source] / (2 * n_steps)
        if not passes(this, lane, offset, passing, n_steps):
            continue
        passage = Passage(offset, passing, scatter(this, lane, float(nearest - rank), last), race)
        pass_spall(shape, batch, this, lane, ball, passage, n_steps, falls, met)


@njit(**INLINE)
def clear_drops(shape: Shape, batch: Batch, n_steps: int, met: FloatArray) -> None:
    """Set the drops of the last knot back to zero, of the balls that have any: a knot writes a few of all rows."""
    wide()
    for ball in range(shape.balls):
        if met[ball] > 0.0:
            met[ball] = 0.0
            for half_step in range(2 * n_steps + 1):
                drops = batch.params[(drop_row(shape) + half_step * shape.balls + ball) * LANES :]
                for lane in range(LANES):  # of a length that LLVM knows: otherwise it calls memset for each row
                    drops[lane] = 0.0


@njit(**INLINE)
def move_spalls(shape: Shape, batch: Batch, n_steps: int, moves: FloatArray, work: FloatArray, met: FloatArray) -> None:
    """Set the drops of all balls over all spalls, at every half step up to the next knot.

    ``work`` has four rows and room for all half steps; ``met`` is the array of :func:`none_met`.
    """
    wide()
    clear_drops(shape, batch, n_steps, met)
    jump_axes(batch)
    angles, starts, slopes, near, falls = batch.angles, 0, LANES, 2 * LANES, work[3 * LANES :]
    for spall in range(batch.spalls.size // (SPALL_ROWS * LANES)):
        this = batch.spalls[spall * SPALL_ROWS * LANES :]
        for lane in range(lane_count(batch.n_records)):
            with_cage, with_shaft = this[SpallRow.WITH_CAGE * LANES + lane], this[SpallRow.WITH_SHAFT * LANES + lane]
            with_spin, period = this[SpallRow.WITH_SPIN * LANES + lane], this[SpallRow.PERIOD * LANES + lane]
            start = with_cage * angles[Angle.CAGE * LANES + lane] + with_shaft * angles[Angle.SHAFT * LANES + lane]
            spin = angles[Angle.SPIN * LANES + lane] + batch.drive[Drive.AXIS_SHIFT * LANES + lane]
            start += with_spin * spin + this[SpallRow.POSITION * LANES + lane]
            slope = with_cage * moves[Angle.CAGE * LANES + lane] + with_shaft * moves[Angle.SHAFT * LANES + lane]
            slope += with_spin * moves[Angle.SPIN * LANES + lane]
            middle = start + 0.5 * slope
            away = abs(middle - period * np.rint(middle / period)) - 0.5 * abs(slope)
            work[starts + lane], work[slopes + lane] = start, slope
            work[near + lane] = 1.0 if away < this[SpallRow.REACH * LANES + lane] else 0.0
        for lane in range(lane_count(batch.n_records)):
            if work[near + lane] > 0.0:
                start, slope = work[starts + lane], work[slopes + lane]
                meet_spall(shape, batch, spall, lane, n_steps, start, slope, falls, met)
    dropping = 0.0
    for ball in range(shape.balls):
        dropping = max(dropping, met[ball])
    batch.params[(drop_row(shape) - 1) * LANES] = dropping
