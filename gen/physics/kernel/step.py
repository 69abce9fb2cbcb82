"""One step of the classical Runge-Kutta method for every lane.

The loop over lanes has no branch and no call, and its body is one stage of the step of one record in scalars, so that LLVM turns it into
vector instructions. While the forces of one group of lanes add up, the processor works on the next group. One body with all four stages
is not faster, and compiling it takes twice as long.
"""

import numpy as np
from numba import njit

from gen.physics.kernel.compiling import INLINE, LANES, as_lane, fma, lane_count, wide
from gen.physics.kernel.equations import Instant, accelerations
from gen.physics.kernel.layout import AXES, PICKUPS, Batch, FloatArray, Param, Shape, State, drop_row

Dynamic = tuple[float, ...]
"""Coordinates and rates of a lane, or their slopes."""


@njit(**INLINE)
def read(shape: Shape, state: FloatArray, row: int, lane: int) -> Dynamic:
    """The twelve rows of a lane from ``row`` on; the rows of the sensor are 0 if there is none."""
    i = row * LANES + lane
    xr = yr = ur = vr = 0.0
    if len(shape.resonator):
        xr, yr, ur, vr = state[i + 4 * LANES], state[i + 5 * LANES], state[i + 10 * LANES], state[i + 11 * LANES]
    return (
        state[i], state[i + LANES], state[i + 2 * LANES], state[i + 3 * LANES], xr, yr,
        state[i + 6 * LANES], state[i + 7 * LANES], state[i + 8 * LANES], state[i + 9 * LANES], ur, vr,
    )  # fmt: skip


@njit(**INLINE)
def write(shape: Shape, state: FloatArray, row: int, lane: int, q: Dynamic) -> None:
    """Store the twelve rows of a lane from ``row`` on, or eight without a sensor; LLVM would see a branch in a loop over them."""
    i = row * LANES + lane
    state[i], state[i + LANES], state[i + 2 * LANES], state[i + 3 * LANES] = q[0], q[1], q[2], q[3]
    state[i + 6 * LANES], state[i + 7 * LANES], state[i + 8 * LANES], state[i + 9 * LANES] = q[6], q[7], q[8], q[9]
    if len(shape.resonator):
        state[i + 4 * LANES], state[i + 5 * LANES], state[i + 10 * LANES], state[i + 11 * LANES] = (
            q[4],
            q[5],
            q[10],
            q[11],
        )


@njit(**INLINE)
def moved(shape: Shape, q: Dynamic, slope: Dynamic, h: float) -> Dynamic:
    """State after ``h`` seconds along a slope."""
    xr = yr = ur = vr = 0.0
    if len(shape.resonator):
        xr, yr, ur, vr = (
            fma(h, slope[4], q[4]),
            fma(h, slope[5], q[5]),
            fma(h, slope[10], q[10]),
            fma(h, slope[11], q[11]),
        )
    return (
        fma(h, slope[0], q[0]), fma(h, slope[1], q[1]), fma(h, slope[2], q[2]), fma(h, slope[3], q[3]), xr, yr,
        fma(h, slope[6], q[6]), fma(h, slope[7], q[7]), fma(h, slope[8], q[8]), fma(h, slope[9], q[9]), ur, vr,
    )  # fmt: skip


@njit(**INLINE)
def half_turn(state: FloatArray, params: FloatArray, lane: int) -> None:
    """Rotate the directions of cage and shaft by half a step."""
    c, s = state[State.CAGE_COS * LANES + lane], state[State.CAGE_SIN * LANES + lane]
    dc, ds = params[Param.CAGE_TURN_COS * LANES + lane], params[Param.CAGE_TURN_SIN * LANES + lane]
    state[State.CAGE_COS * LANES + lane] = fma(c, dc, -(s * ds))
    state[State.CAGE_SIN * LANES + lane] = fma(s, dc, c * ds)
    c, s = state[State.SHAFT_COS * LANES + lane], state[State.SHAFT_SIN * LANES + lane]
    dc, ds = params[Param.SHAFT_TURN_COS * LANES + lane], params[Param.SHAFT_TURN_SIN * LANES + lane]
    state[State.SHAFT_COS * LANES + lane] = fma(c, dc, -(s * ds))
    state[State.SHAFT_SIN * LANES + lane] = fma(s, dc, c * ds)


@njit(**INLINE)
def slopes_of(
    shape: Shape, state: FloatArray, params: FloatArray, instant: Instant, lane: int
) -> tuple[Dynamic, Dynamic, float]:
    """Coordinates and rates of a lane, their derivatives, and the sum of ``squeeze**(n - 1)`` of its balls."""
    q = read(shape, state, State.COORDINATES, lane)
    directions = (
        state[State.CAGE_COS * LANES + lane],
        state[State.CAGE_SIN * LANES + lane],
        state[State.SHAFT_COS * LANES + lane],
        state[State.SHAFT_SIN * LANES + lane],
    )
    a1x, a1y, a2x, a2y, arx, ary, roots = accelerations(shape, q, directions, instant, lane, params)
    return q, (q[6], q[7], q[8], q[9], q[10], q[11], a1x, a1y, a2x, a2y, arx, ary), roots


@njit(**INLINE)
def first_stage(shape: Shape, batch: Batch, dt: float, instant: Instant) -> None:
    """First stage: store the beginning of the step and its slope, and move half a step along that slope."""
    wide()
    state, params = batch.state, batch.params
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        q, slope, roots = slopes_of(shape, state, params, instant, lane)
        state[State.STEEPEST * LANES + lane] = max(state[State.STEEPEST * LANES + lane], roots)
        write(shape, state, State.BEGINNING, lane, q)
        write(shape, state, State.SLOPES, lane, slope)
        write(shape, state, State.COORDINATES, lane, moved(shape, q, slope, 0.5 * dt))


@njit(**INLINE)
def later_stage(shape: Shape, batch: Batch, dt: float, instant: Instant, stage: int | np.int64) -> None:
    """Stage 1, 2 or 3: add its slope to the weighted sum of slopes, and compute the state at which the next stage begins.

    That state is the beginning of the step plus ``along_all`` times the sum plus ``ahead`` times the new slope [s]; the sum counts at the
    end of the step only. Stages 1 and 2 are at the same time, so the directions turn before stages 1 and 3; in a loop of their own they
    would take 2 % more of a step.
    """
    last = stage == 3
    weight, ahead, along_all = (1.0, 0.0, dt / 6) if last else (2.0, dt * (0.5 * stage), 0.0)
    wide()
    state, params = batch.state, batch.params
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        if stage != 2:
            half_turn(state, params, lane)
        _, slope, _ = slopes_of(shape, state, params, instant, lane)
        total = moved(shape, read(shape, state, State.SLOPES, lane), slope, weight)
        write(shape, state, State.SLOPES, lane, total)
        write(
            shape,
            state,
            State.COORDINATES,
            lane,
            moved(shape, moved(shape, read(shape, state, State.BEGINNING, lane), total, along_all), slope, ahead),
        )


@njit(**INLINE)
def pick_up(shape: Shape, batch: Batch, received: FloatArray) -> None:
    """Weighted sum of the displacements or accelerations at the beginning of a step, for each channel."""
    wide()
    picked = batch.state[(State.BEGINNING if len(shape.displacement) else State.SLOPES + AXES) * LANES :]
    weights = batch.params[PICKUPS * LANES :]
    for lane in range(lane_count(batch.n_records)):
        for channel in range(len(shape.channels)):
            value = 0.0
            for axis in range(AXES if len(shape.resonator) else 4):
                value = fma(weights[(channel * AXES + axis) * LANES + lane], picked[axis * LANES + lane], value)
            received[channel * LANES + lane] = value


@njit(**INLINE)
def advance(shape: Shape, batch: Batch, dt: float, n_steps: int, since: float, history: FloatArray, at: int) -> None:
    """Advance every lane from one knot to the next by ``n_steps`` classical Runge-Kutta steps.

    Parameters
    ----------
    shape : Shape
        Parts that the kernel contains.
    batch : Batch
        Its ``state`` is advanced; its ``params`` hold until the next knot.
    dt : float
        Step [s].
    n_steps : int
        Steps to the next knot.
    since : float
        Half steps since the directions of the balls were last computed.
    history : array, shape (step * channel * LANES + lane)
        Receives, from its row ``at`` on, the value of each channel at the start of each step [m s-2, or m].
    at : int
        First row of ``history`` to fill; a row is a step and a channel.
    """
    params, drops, width = batch.params, drop_row(shape) * LANES, 0
    if len(shape.spalled) and params[drops - LANES] > 0.0:  # otherwise the zeros of one half step serve them all
        width = len(shape.balls) * LANES
    for step in range(n_steps):
        half_step = 2.0 * step
        # a view of the drops: for an index, numba would test whether it counts from the end
        start = Instant(half_step, since + half_step, params[drops + 2 * step * width :])
        first_stage(shape, batch, dt, start)
        pick_up(shape, batch, history[(at + step * len(shape.channels)) * LANES :])
        for stage in range(1, 4):
            passed = 1 if stage < 3 else 2
            instant = Instant(
                half_step + passed, since + half_step + passed, params[drops + (2 * step + passed) * width :]
            )
            later_stage(shape, batch, dt, instant, stage)
