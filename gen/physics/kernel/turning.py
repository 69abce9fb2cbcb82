"""How shaft, cage and balls turn from one knot to the next.

Speed, slip, spin, jitter and the tilt of the spin axis are slow random processes: sums of a few cosines with drawn frequencies and phases.
Each cosine is a phasor that is rotated every ``STRIDE`` knots; between these knots the processes change linearly. So a process needs no
table in memory and does not depend on the step.
"""

import math

import numpy as np
from numba import njit

from gen.physics.kernel.chance import standard_normal
from gen.physics.kernel.compiling import INLINE, LANES, cosine, fma, lane_count, sine, wide
from gen.physics.kernel.contacts import COS, SIN
from gen.physics.kernel.layout import (
    CONTACT_ROWS,
    JITTER_FIRST,
    JITTER_TERMS,
    SLIP_FIRST,
    SLIP_TERMS,
    SPEED_TERMS,
    SPIN_FIRST,
    SPIN_TERMS,
    TILT_FIRST,
    TILT_TERMS,
    Angle,
    Batch,
    Contact,
    Drive,
    FloatArray,
    Param,
    Process,
    Shape,
    State,
    contact_row,
    slow_rows,
)  # fmt: skip

# of each kind of process, in the order of Process
N_TERMS = np.array([SPEED_TERMS, SLIP_TERMS, SPIN_TERMS, TILT_TERMS, JITTER_TERMS])
FIRST_TERMS = np.array([0, SLIP_FIRST, SPIN_FIRST, TILT_FIRST, JITTER_FIRST])
RMS_ROWS = np.array([Drive.SPEED_RMS, Drive.SLIP_RMS, Drive.SPIN_RMS, Drive.AXIS_RMS, Drive.JITTER_RMS], dtype=int)
STRIDE = 8  # knots over which processes change linearly: the period of their fastest terms, at twice the shaft rate, is tens of knots
N_ANGLES = len(Angle)


@njit(**INLINE)
def turn_and_sum(n_terms: int, turning: bool, first: int, rms: int, batch: Batch, values: FloatArray) -> None:
    """Value of one process for every lane, into ``values``.

    If it is ``turning``, its phasors are rotated by ``STRIDE`` knots first. ``first`` is the first of its terms, ``rms`` the row of
    ``batch.drive`` with its rms.
    """
    wide()
    own, size, scale = batch.phasors[4 * first * LANES :], batch.drive[rms * LANES :], math.sqrt(2.0 / n_terms)
    for lane in range(lane_count(batch.n_records)):
        values[lane] = 0.0
    for term in range(n_terms):
        phasor = own[4 * term * LANES :]
        for lane in range(lane_count(batch.n_records)):
            c, s = phasor[lane], phasor[LANES + lane]
            dc, ds = phasor[2 * LANES + lane], phasor[3 * LANES + lane]
            dc, ds = (dc, ds) if turning else (1.0, 0.0)
            c, s = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)
            phasor[lane], phasor[LANES + lane] = c, s
            values[lane] += c
    for lane in range(lane_count(batch.n_records)):
        values[lane] *= scale * size[lane]


@njit(**INLINE)
def processes(shape: Shape, batch: Batch, turning: bool, values: FloatArray) -> None:
    """Values of all processes, rows of :class:`Process`; see :func:`turn_and_sum`."""
    drive = batch.drive
    for process in range(slow_rows(shape)):
        ball = max(process - Process.JITTER, 0)
        kind = process - ball
        first = FIRST_TERMS[kind] + JITTER_TERMS * ball
        turn_and_sum(N_TERMS[kind], turning, first, RMS_ROWS[kind], batch, values[process * LANES :])
    for ball in range(shape.balls if shape.jittered else 0):
        jitter = values[(Process.JITTER + ball) * LANES :]
        for lane in range(lane_count(batch.n_records)):
            late = drive[Drive.LATE_BALL * LANES + lane] == ball
            jitter[lane] += drive[Drive.LATE_BY * LANES + lane] if late else 0.0


@njit(**INLINE)
def move_processes(shape: Shape, batch: Batch, knot: int, n_steps: int, after: FloatArray) -> None:
    """Set the slopes of every process, and of the direction of every ball in its pocket, for the next ``STRIDE`` knots.

    Each reaches its exact value ``STRIDE`` knots from now. ``after`` is a work array of as many rows as there are processes.
    """
    wide()
    # in a loop, so that the code of processes is compiled once
    for later in range(0 if knot == 0 else 1, 2):
        processes(shape, batch, later == 1, after)
        if later == 0:
            for i in range(slow_rows(shape) * lane_count(LANES)):
                batch.slow[i] = after[i]
    rows = slow_rows(shape)
    if shape.jittered:
        for ball in range(shape.balls):
            line = batch.params[(contact_row(shape) + CONTACT_ROWS * ball) * LANES :]
            now, later = batch.slow[(Process.JITTER + ball) * LANES :], after[(Process.JITTER + ball) * LANES :]
            ball_c, ball_s = COS[shape.balls, ball], SIN[shape.balls, ball]
            for lane in range(lane_count(batch.n_records)):
                c, s = cosine(now[lane]), sine(now[lane])
                start_c, start_s = fma(ball_c, c, -(ball_s * s)), fma(ball_s, c, ball_c * s)
                c, s = cosine(later[lane]), sine(later[lane])
                line[Contact.COS * LANES + lane], line[Contact.SIN * LANES + lane] = start_c, start_s
                per_half_step = 1 / (2 * n_steps * STRIDE)
                line[Contact.COS_SLOPE * LANES + lane] = (fma(ball_c, c, -(ball_s * s)) - start_c) * per_half_step
                line[Contact.SIN_SLOPE * LANES + lane] = (fma(ball_s, c, ball_c * s) - start_s) * per_half_step
    slopes = batch.slow[rows * LANES :]
    for i in range(rows * lane_count(LANES)):
        slopes[i] = (after[i] - batch.slow[i]) * (1 / STRIDE)


@njit(**INLINE)
def new_walk(batch: Batch, knot: int) -> None:
    """Draw the random slip of every lane for the next ``STRIDE`` knots: white noise, so that the angle of the cage walks at random."""
    for lane in range(lane_count(batch.n_records)):
        rms = batch.drive[Drive.WALK * LANES + lane]
        if rms > 0.0:
            drawn = standard_normal(knot // STRIDE, batch.drive[Drive.WALK_SEED * LANES + lane])
            batch.drive[Drive.WALK_NOW * LANES + lane] = rms * drawn


@njit(**INLINE)
def turn_rings(shape: Shape, batch: Batch, knot: int, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Set the rotation per half step and the unbalance up to the next knot.

    ``moves`` receives the angles by which shaft, cage and ball spin turn up to that knot, rows of :class:`Angle` [rad].
    """
    wide()
    params, drive, state, slow = batch.params, batch.drive, batch.state, batch.slow
    slopes = slow[slow_rows(shape) * LANES :]
    half, per_second = 0.5 / n_steps, 1 / (n_steps * dt) ** 2
    scheduled = min(knot, len(batch.schedule) - 1)
    for lane in range(lane_count(batch.n_records)):
        speed = 1 + fma(0.5, slopes[Process.SPEED * LANES + lane], slow[Process.SPEED * LANES + lane])
        slip = fma(0.5, slopes[Process.SLIP * LANES + lane], slow[Process.SLIP * LANES + lane])
        slip = drive[Drive.MEAN_SLIP * LANES + lane] + slip + drive[Drive.WALK_NOW * LANES + lane]
        wander = 1 + fma(0.5, slopes[Process.SPIN * LANES + lane], slow[Process.SPIN * LANES + lane])
        shaft = drive[Drive.SHAFT_STEP * LANES + lane] * speed
        if scheduled >= 0:
            shaft *= batch.schedule[scheduled, 0, lane]
        cage = drive[Drive.CAGE_RATIO * LANES + lane] * shaft * (1 - slip)
        speeding_up = shaft - moves[Angle.SHAFT * LANES + lane] if knot > 0 else 0.0
        moves[Angle.SHAFT * LANES + lane] = shaft
        moves[Angle.CAGE * LANES + lane] = cage
        moves[Angle.SPIN * LANES + lane] = drive[Drive.SPIN_RATIO * LANES + lane] * shaft * wander
        params[Param.CAGE_TURN_COS * LANES + lane] = cosine(cage * half)
        params[Param.CAGE_TURN_SIN * LANES + lane] = sine(cage * half)
        params[Param.SHAFT_TURN_COS * LANES + lane] = cosine(shaft * half)
        params[Param.SHAFT_TURN_SIN * LANES + lane] = sine(shaft * half)
        moment = drive[Drive.UNBALANCE * LANES + lane] * per_second
        params[Param.UNBALANCE_RADIAL * LANES + lane] = fma(moment * shaft, shaft, drive[Drive.BOW * LANES + lane])
        params[Param.UNBALANCE_TANGENTIAL * LANES + lane] = moment * speeding_up
    # after 1e5 rotations a direction keeps its angle to 1e-13, but its length drifts: bring it back to 1
    for row in (State.CAGE_COS, State.SHAFT_COS):
        direction = state[row * LANES :]
        for lane in range(lane_count(batch.n_records)):
            c, s = direction[lane], direction[LANES + lane]
            stretch = 1.5 - 0.5 * fma(c, c, s * s)
            direction[lane], direction[LANES + lane] = c * stretch, s * stretch


@njit(**INLINE)
def keep_turning(shape: Shape, batch: Batch, moves: FloatArray) -> None:
    """Advance angles and processes to the next knot."""
    wide()
    for i in range(N_ANGLES * lane_count(LANES)):
        batch.angles[i] += moves[i]
    slopes = batch.slow[slow_rows(shape) * LANES :]
    for i in range(slopes.size):
        batch.slow[i] += slopes[i]
