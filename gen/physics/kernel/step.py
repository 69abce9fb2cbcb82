"""One step of the classical Runge-Kutta method for every lane.

A loop over lanes has no branch and no call, and its body computes one record in scalars, so that LLVM turns it into vector instructions.
A stage is three such loops: the motion in the frame of the cage, the force of the balls, four in a loop, and the rest of the equations.
"""

from numba import njit

from gen.physics.kernel.compiling import INLINE, LANES, as_lane, fma, lane_count, wide
from gen.physics.kernel.contacts import Instant, push_of_balls
from gen.physics.kernel.equations import accelerations
from gen.physics.kernel.layout import AXES, PICKUPS, Batch, FloatArray, Param, Shape, State, contact_row, drop_row

Dynamic = tuple[float, ...]
"""Coordinates and rates of a lane, or their slopes."""


@njit(**INLINE)
def read(state: FloatArray, row: int, lane: int) -> Dynamic:
    """The twelve rows of a lane from ``row`` on."""
    i = row * LANES + lane
    return (
        state[i], state[i + LANES], state[i + 2 * LANES], state[i + 3 * LANES], state[i + 4 * LANES], state[i + 5 * LANES],
        state[i + 6 * LANES], state[i + 7 * LANES], state[i + 8 * LANES], state[i + 9 * LANES], state[i + 10 * LANES],
        state[i + 11 * LANES],
    )  # fmt: skip


@njit(**INLINE)
def write(state: FloatArray, row: int, lane: int, q: Dynamic) -> None:
    """Store the twelve rows of a lane from ``row`` on; LLVM would see a branch in a loop over them."""
    i = row * LANES + lane
    state[i], state[i + LANES], state[i + 2 * LANES], state[i + 3 * LANES] = q[0], q[1], q[2], q[3]
    state[i + 4 * LANES], state[i + 5 * LANES], state[i + 6 * LANES], state[i + 7 * LANES] = q[4], q[5], q[6], q[7]
    state[i + 8 * LANES], state[i + 9 * LANES], state[i + 10 * LANES], state[i + 11 * LANES] = q[8], q[9], q[10], q[11]


@njit(**INLINE)
def moved(q: Dynamic, slope: Dynamic, h: float) -> Dynamic:
    """State after ``h`` seconds along a slope."""
    return (
        fma(h, slope[0], q[0]), fma(h, slope[1], q[1]), fma(h, slope[2], q[2]), fma(h, slope[3], q[3]),
        fma(h, slope[4], q[4]), fma(h, slope[5], q[5]), fma(h, slope[6], q[6]), fma(h, slope[7], q[7]),
        fma(h, slope[8], q[8]), fma(h, slope[9], q[9]), fma(h, slope[10], q[10]), fma(h, slope[11], q[11]),
    )  # fmt: skip


@njit(**INLINE)
def half_turn(batch: Batch) -> None:
    """Rotate the directions of cage and shaft by half a step."""
    wide()
    state, params = batch.state, batch.params
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        c, s = state[State.CAGE_COS * LANES + lane], state[State.CAGE_SIN * LANES + lane]
        dc, ds = params[Param.CAGE_TURN_COS * LANES + lane], params[Param.CAGE_TURN_SIN * LANES + lane]
        state[State.CAGE_COS * LANES + lane] = fma(c, dc, -(s * ds))
        state[State.CAGE_SIN * LANES + lane] = fma(s, dc, c * ds)
        c, s = state[State.SHAFT_COS * LANES + lane], state[State.SHAFT_SIN * LANES + lane]
        dc, ds = params[Param.SHAFT_TURN_COS * LANES + lane], params[Param.SHAFT_TURN_SIN * LANES + lane]
        state[State.SHAFT_COS * LANES + lane] = fma(c, dc, -(s * ds))
        state[State.SHAFT_SIN * LANES + lane] = fma(s, dc, c * ds)


@njit(**INLINE)
def slopes_of(state: FloatArray, params: FloatArray, half_step: float, lane: int) -> tuple[Dynamic, Dynamic]:
    """Coordinates and rates of a lane, and their derivatives."""
    q = read(state, State.COORDINATES, lane)
    return q, q[6:] + accelerations(q, half_step, state, params, lane)


@njit(**INLINE)
def first_stage(batch: Batch, dt: float, half_step: float) -> None:
    """First stage: store the beginning of the step and its slope, and move half a step along that slope."""
    wide()
    state, params = batch.state, batch.params
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        q, slope = slopes_of(state, params, half_step, lane)
        powers = state[(State.PUSH + 2) * LANES + lane]
        state[State.STEEPEST * LANES + lane] = max(state[State.STEEPEST * LANES + lane], powers)
        write(state, State.BEGINNING, lane, q)
        write(state, State.SLOPES, lane, slope)
        write(state, State.COORDINATES, lane, moved(q, slope, 0.5 * dt))


@njit(**INLINE)
def later_stage(batch: Batch, dt: float, half_step: float, stage: int) -> None:
    """Stage 1, 2 or 3: add its slope to the weighted sum of slopes, and compute the state at which the next stage begins.

    That state is the beginning of the step plus ``along_all`` times the sum plus ``ahead`` times the new slope [s]; the sum counts at the
    end of the step only.
    """
    last = stage == 3
    weight, ahead, along_all = (1.0, 0.0, dt / 6) if last else (2.0, dt * (0.5 * stage), 0.0)
    wide()
    state, params = batch.state, batch.params
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        _, slope = slopes_of(state, params, half_step, lane)
        total = moved(read(state, State.SLOPES, lane), slope, weight)
        write(state, State.SLOPES, lane, total)
        q = moved(moved(read(state, State.BEGINNING, lane), total, along_all), slope, ahead)
        write(state, State.COORDINATES, lane, q)


@njit(**INLINE)
def pick_up(shape: Shape, batch: Batch, history: FloatArray, at: int, room: int) -> None:
    """Weighted sum of the displacements or accelerations at the beginning of a step, for each channel."""
    wide()
    picked = batch.state[(State.BEGINNING if shape.displacement else State.SLOPES + AXES) * LANES :]
    for channel in range(shape.channels):
        weights = batch.params[(PICKUPS + channel * AXES) * LANES :]
        received = history[channel * room + at * LANES :]
        for lane in range(lane_count(batch.n_records)):
            value = weights[lane] * picked[lane]
            value = fma(weights[LANES + lane], picked[LANES + lane], value)
            value = fma(weights[2 * LANES + lane], picked[2 * LANES + lane], value)
            value = fma(weights[3 * LANES + lane], picked[3 * LANES + lane], value)
            value = fma(weights[4 * LANES + lane], picked[4 * LANES + lane], value)
            received[lane] = fma(weights[5 * LANES + lane], picked[5 * LANES + lane], value)


@njit(**INLINE)
def advance(
    shape: Shape, batch: Batch, dt: float, n_steps: int, since: float, history: FloatArray, at: int, room: int
) -> None:
    """Advance every lane from one knot to the next by ``n_steps`` classical Runge-Kutta steps.

    Parameters
    ----------
    shape : Shape
        What the records of the batch have.
    batch : Batch
        Its ``state`` is advanced; its ``params`` hold until the next knot.
    dt : float
        Step [s].
    n_steps : int
        Steps to the next knot.
    since : float
        Half steps since the directions of the balls were last computed.
    history : array, shape (channel * room + step * LANES + lane)
        Receives, from its step ``at`` on, the value of each channel at the start of each step [m s-2, or m].
    at : int
        First step of ``history`` to fill.
    room : int
        Values of ``history`` that belong to a channel.
    """
    params, drops, width = batch.params, drop_row(shape) * LANES, 0
    if params[drops - LANES] > 0.0:  # otherwise the zeros of one half step serve them all
        width = shape.balls * LANES
    # views of contacts and drops: for an index, numba would test whether it counts from the end
    contacts = params[contact_row(shape) * LANES :]
    for step in range(n_steps):
        for stage in range(4):
            passed = 2 * step + (stage + 1) // 2
            instant = Instant(float(passed), since + passed, contacts, params[drops + passed * width :])
            if stage & 1:
                half_turn(batch)
            push_of_balls(shape, batch, instant)
            if stage == 0:
                first_stage(batch, dt, instant.half_step)
                pick_up(shape, batch, history, at + step, room)
            else:
                later_stage(batch, dt, instant.half_step, stage)
