"""The Runge-Kutta step that advances the equations of motion.

The loop over lanes has no branch and no call, and its body is one stage of the classical step of a record in scalars, so that LLVM turns
it into vector instructions. While the forces of one group of lanes add up, the processor is at the next; with all four stages in one
body it is not faster, and that body takes twice as long to compile.
"""

from numba import njit

from gen.physics.kernel.compiling import INLINE, LANES, fma, lane_count, wide
from gen.physics.kernel.equations import (
    AXES,
    BEGINNING,
    CAGE_C,
    CAGE_S,
    CAGE_TURN_C,
    PICKUPS,
    SHAFT_C,
    SHAFT_S,
    SHAFT_TURN_C,
    SLOPES,
    STEEPEST,
    FloatArray,
    Instant,
    Shape,
    accelerations,
    drop_row,
)  # fmt: skip

State = tuple[float, ...]


@njit(**INLINE)
def read(shape: Shape, state: FloatArray, row: int, lane: int) -> State:
    """Twelve rows of a lane; a sensor that is not there stands still."""
    i = row * LANES + lane
    xr = yr = ur = vr = 0.0
    if len(shape.resonator):
        xr, yr, ur, vr = state[i + 4 * LANES], state[i + 5 * LANES], state[i + 10 * LANES], state[i + 11 * LANES]
    return (
        state[i], state[i + LANES], state[i + 2 * LANES], state[i + 3 * LANES], xr, yr,
        state[i + 6 * LANES], state[i + 7 * LANES], state[i + 8 * LANES], state[i + 9 * LANES], ur, vr,
    )  # fmt: skip


@njit(**INLINE)
def write(shape: Shape, state: FloatArray, row: int, lane: int, q: State) -> None:
    """Twelve rows of a lane, less those of a sensor that is not there; a loop over them would be a branch to LLVM."""
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
def moved(shape: Shape, q: State, slope: State, h: float) -> State:
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
def half_turn(state: FloatArray, params: FloatArray) -> None:
    """Turn the directions of cage and shaft by half a step."""
    wide()
    for lane in range(lane_count()):
        for row, turn in ((CAGE_C, CAGE_TURN_C), (SHAFT_C, SHAFT_TURN_C)):
            c, s = state[row * LANES + lane], state[(row + 1) * LANES + lane]
            dc, ds = params[turn * LANES + lane], params[(turn + 1) * LANES + lane]
            state[row * LANES + lane], state[(row + 1) * LANES + lane] = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)


@njit(**INLINE)
def slopes_of(
    shape: Shape, state: FloatArray, params: FloatArray, instant: Instant, lane: int
) -> tuple[State, State, float]:
    """State of a lane, its derivative, and the sum of the powers of its balls."""
    q = read(shape, state, 0, lane)
    turn = (
        state[CAGE_C * LANES + lane], state[CAGE_S * LANES + lane], state[SHAFT_C * LANES + lane], state[SHAFT_S * LANES + lane],
    )  # fmt: skip
    a1x, a1y, a2x, a2y, arx, ary, powers = accelerations(shape, q, turn, instant, lane, params)
    return q, (q[6], q[7], q[8], q[9], q[10], q[11], a1x, a1y, a2x, a2y, arx, ary), powers


@njit(**INLINE)
def first_stage(shape: Shape, state: FloatArray, params: FloatArray, dt: float, instant: Instant) -> None:
    """Begin a step: note where and with which slope, and go half a step along it."""
    wide()
    for lane in range(LANES):
        q, slope, powers = slopes_of(shape, state, params, instant, lane)
        state[STEEPEST * LANES + lane] = max(state[STEEPEST * LANES + lane], powers)
        write(shape, state, BEGINNING, lane, q)
        write(shape, state, SLOPES, lane, slope)
        write(shape, state, 0, lane, moved(shape, q, slope, 0.5 * dt))


@njit(**INLINE)
def later_stage(
    shape: Shape, state: FloatArray, params: FloatArray, instant: Instant, weight: float, ahead: float, along_all: float
) -> None:
    """Add a slope to the sum with its ``weight``; go ``ahead`` of the beginning along it, and ``along_all`` along the sum [s]."""
    wide()
    for lane in range(LANES):
        _, slope, _ = slopes_of(shape, state, params, instant, lane)
        total = moved(shape, read(shape, state, SLOPES, lane), slope, weight)
        write(shape, state, SLOPES, lane, total)
        write(
            shape,
            state,
            0,
            lane,
            moved(shape, moved(shape, read(shape, state, BEGINNING, lane), total, along_all), slope, ahead),
        )


@njit(**INLINE)
def pick_up(shape: Shape, state: FloatArray, params: FloatArray, received: FloatArray) -> None:
    """Weighted sums of displacements or accelerations at the beginning of a step, one for each channel."""
    wide()
    picked = state[(BEGINNING if len(shape.displacement) else SLOPES + AXES) * LANES :]
    weights = params[PICKUPS * LANES :]
    for lane in range(lane_count()):
        for channel in range(len(shape.channels)):
            value = 0.0
            for axis in range(AXES if len(shape.resonator) else 4):
                value = fma(weights[(channel * AXES + axis) * LANES + lane], picked[axis * LANES + lane], value)
            received[channel * LANES + lane] = value


@njit(**INLINE)
def advance(
    shape: Shape,
    state: FloatArray,
    params: FloatArray,
    dt: float,
    n_steps: int,
    since: float,
    history: FloatArray,
    at: int,
) -> None:
    """Advance every lane from one knot to the next by ``n_steps`` classical Runge-Kutta steps.

    Parameters
    ----------
    shape : Shape
        What the kernel contains.
    state, params : array, shape (row * LANES + lane)
        What moves, and what holds until the next knot.
    dt : float
        Step [s].
    n_steps : int
        Steps to the next knot.
    since : float
        Half steps since the directions of the balls were laid down.
    history : array, shape (step * channel * LANES + lane)
        Receives, from its row ``at`` on, what is picked up at the start of each step [m s-2, or m].
    at : int
        First row of ``history`` to fill; a row is a step and a channel.
    """
    drops, width = drop_row(shape) * LANES, len(shape.balls) * LANES if len(shape.spalled) else 0
    for step in range(n_steps):
        half_step = 2.0 * step
        # views, since numba would look at every index whether it counts from the end
        start = Instant(half_step, since + half_step, params[drops + 2 * step * width :])
        first_stage(shape, state, params, dt, start)
        pick_up(shape, state, params, history[(at + step * len(shape.channels)) * LANES :])
        for stage in range(1, 4):
            passed = 1 if stage < 3 else 2
            if stage != 2:
                half_turn(state, params)
            instant = Instant(
                half_step + passed, since + half_step + passed, params[drops + (2 * step + passed) * width :]
            )
            last = stage == 3
            ahead = 0.0 if last else dt * (0.5 * stage)
            later_stage(shape, state, params, instant, 1.0 if last else 2.0, ahead, dt / 6 if last else 0.0)
