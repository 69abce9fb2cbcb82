"""The equations of motion of shaft, housing and sensor, and the Runge-Kutta step that advances them.

A lane holds one record; the loop over lanes has no branch and no call, and its body is the whole classical Runge-Kutta step of that
record in scalars, so that LLVM turns it into vector instructions. Between two knots (one per output sample) every slow quantity moves
along a straight line: cage and shaft turn at a constant rate, ball gaps, ball jitter and spall offsets are linear in time.

Body 1 is the shaft with the inner ring, 2 the housing with the outer ring, r the sensor on its resonance. Balls push along their own
direction in the frame of the cage, in which they stand still but for their jitter. The system is that of Ophel et al. with its signs
and reactions corrected, plus a sensor mass: Lagrange's equations of the energies in docs/model.md.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gen.physics.lanes import INLINE, LANES

FloatArray = NDArray[np.float64]

MAX_BALLS = 24
_COUNT = np.maximum(np.arange(MAX_BALLS + 1), 1)[:, None]
COS = np.cos(2 * np.pi * np.arange(MAX_BALLS) / _COUNT)  # (number of balls, ball): direction in the cage's frame
SIN = np.sin(2 * np.pi * np.arange(MAX_BALLS) / _COUNT)

AXES = 6
# Rows of ``state``: coordinates x1 y1 x2 y2 xr yr, their rates, the directions of cage and shaft, the largest sum over all balls of
# the slope of ``squeeze**n / n`` so far (it bounds the contact stiffness), and what was last picked up.
N_DYNAMIC = 2 * AXES
CAGE_C, CAGE_S, SHAFT_C, SHAFT_S, STEEPEST, PICKED = range(N_DYNAMIC, N_DYNAMIC + 6)
N_STATE = PICKED + AXES
# Rows of ``params``: constants of the record, what holds until the next knot (forces with their slopes per half step), the weights of
# the pickups, the jitter of each ball with its slope, and the gap under each ball at every half step.
(
    STIFFNESS, DAMPING, COSA, GAP, IM1, IM2, IMR, C1, C0, K0, K1X, K1Y, K2X, K2Y, C2X, C2Y, KRX, KRY, CR, LOOSENESS, N_CONSTANTS,
) = range(21)  # fmt: skip
(
    CAGE_TURN_C, CAGE_TURN_S, SHAFT_TURN_C, SHAFT_TURN_S, UNBALANCE_P, UNBALANCE_Q, FORCES, N_HELD,
) = (*range(N_CONSTANTS, N_CONSTANTS + 7), N_CONSTANTS + 6 + 8)  # fmt: skip
PICKUPS = N_HELD

Motion = tuple[float, float, float, float]


class Shape(NamedTuple):
    """What a compiled kernel contains, as lengths of tuples (see :mod:`gen.physics.lanes`); a record pays for nothing else."""

    balls: tuple[None, ...]
    channels: tuple[None, ...]
    displacement: tuple[None, ...]
    """Whether channels pick up displacements instead of accelerations."""
    resonator: tuple[None, ...]
    damped: tuple[None, ...]
    uneven: tuple[None, ...]
    """Whether gaps differ from ball to ball and in time: spalls, waviness."""
    jittered: tuple[None, ...]
    """Whether balls leave their place in the cage."""
    forced: tuple[None, ...]
    """Whether forces change between knots: load profiles, misalignment, cage knocks."""
    loose: tuple[None, ...]
    roller: tuple[None, ...]


def make_shape(n_balls: int, n_channels: int, **flags: bool) -> Shape:
    """Shape of a kernel; every flag of :class:`Shape` that is not given is off."""
    counts = {"balls": n_balls, "channels": n_channels, **flags}
    return Shape(*((None,) * int(counts.get(field, 0)) for field in Shape._fields))


@njit(**INLINE)
def jitter_row(shape: Shape) -> int:
    """First row of the jitters in ``params``, two for each ball."""
    return PICKUPS + len(shape.channels) * AXES


@njit(**INLINE)
def gap_row(shape: Shape) -> int:
    """First row of the gaps in ``params``: half step after half step, every ball of each."""
    return jitter_row(shape) + 2 * len(shape.balls)


@njit(**INLINE)
def param_rows(shape: Shape, n_steps: int) -> int:
    """Number of rows of ``params``."""
    return gap_row(shape) + (2 * n_steps + 1) * len(shape.balls)


@njit(**INLINE)
def ninth_root(x: float) -> float:
    """Ninth root, to 1e-13 between 1e-11 and 1e-3: Halley's steps from the eighth root, which square roots give.

    Between those the ninth root is 1.08 to 1.42 times the eighth.
    """
    y = 1.25 * math.sqrt(math.sqrt(math.sqrt(x))) + 1e-300
    for _ in range(3):
        cube = y * y * y
        ninth = cube * cube * cube
        y *= (8 * ninth + 10 * x) / (10 * ninth + 8 * x + 1e-300)
    return y


@njit(**INLINE)
def ball_force(
    shape: Shape, ball: int, motion: Motion, half_step: int, lane: int, params: FloatArray
) -> tuple[float, float, float]:
    """Force of one ball on the housing, along the axes of the cage's frame [N], and its squeeze to the power ``n - 1``."""
    if ball >= len(shape.balls):
        return 0.0, 0.0, 0.0
    x, y, u, v = motion
    ball_c, ball_s = COS[len(shape.balls), ball], SIN[len(shape.balls), ball]
    if len(shape.jittered):
        row = jitter_row(shape) + 2 * ball
        jitter = params[row * LANES + lane] + params[(row + 1) * LANES + lane] * half_step
        square = jitter * jitter
        c = 1 - square * (0.5 - square * (1 / 24 - square * (1 / 720)))
        s = jitter * (1 - square * (1 / 6 - square * (1 / 120 - square * (1 / 5040))))
        ball_c, ball_s = ball_c * c - ball_s * s, ball_s * c + ball_c * s
    gap = params[GAP * LANES + lane]
    if len(shape.uneven):
        gap = params[(gap_row(shape) + half_step * len(shape.balls) + ball) * LANES + lane]
    squeeze = max(x * ball_c + y * ball_s - gap, 0.0)
    power = ninth_root(squeeze) if len(shape.roller) else math.sqrt(squeeze)
    force = params[STIFFNESS * LANES + lane] * (squeeze * power)
    if len(shape.damped):
        approach = u * ball_c + v * ball_s
        damped = max(force + params[DAMPING * LANES + lane] * approach, 0.0)
        force = damped if squeeze > 0.0 else 0.0
    return force * ball_c, force * ball_s, power


@njit(**INLINE)
def four_balls(
    shape: Shape,
    first: int,
    motion: Motion,
    half_step: int,
    lane: int,
    params: FloatArray,
) -> tuple[float, float, float]:
    """Four balls together; a loop over balls would not be unrolled before LLVM looks at the loop over lanes."""
    ax, ay, ap = ball_force(shape, first, motion, half_step, lane, params)
    bx, by, bp = ball_force(shape, first + 1, motion, half_step, lane, params)
    cx, cy, cp = ball_force(shape, first + 2, motion, half_step, lane, params)
    dx, dy, dp = ball_force(shape, first + 3, motion, half_step, lane, params)
    return (ax + bx) + (cx + dx), (ay + by) + (cy + dy), (ap + bp) + (cp + dp)


@njit(**INLINE)
def contact_force(
    shape: Shape, motion: Motion, c: float, s: float, half_step: int, lane: int, params: FloatArray
) -> tuple[float, float, float]:
    """Force that all balls together put on the housing, and its reaction on the shaft [N], and the sum of their powers.

    ``motion`` is displacement and velocity of the shaft relative to the housing; ``c`` and ``s`` are the direction of the cage.
    """
    cosa = params[COSA * LANES + lane]
    x, y, u, v = motion
    seen = (cosa * (x * c + y * s), cosa * (y * c - x * s), cosa * (u * c + v * s), cosa * (v * c - u * s))
    ax, ay, ap = four_balls(shape, 0, seen, half_step, lane, params)
    bx, by, bp = four_balls(shape, 4, seen, half_step, lane, params)
    cx, cy, cp = four_balls(shape, 8, seen, half_step, lane, params)
    dx, dy, dp = four_balls(shape, 12, seen, half_step, lane, params)
    ex, ey, ep = four_balls(shape, 16, seen, half_step, lane, params)
    fx, fy, fp = four_balls(shape, 20, seen, half_step, lane, params)
    along, across = cosa * (ax + bx + cx + dx + ex + fx), cosa * (ay + by + cy + dy + ey + fy)
    return along * c - across * s, along * s + across * c, ap + bp + cp + dp + ep + fp


@njit(**INLINE)
def forces(shape: Shape, half_step: int, lane: int, params: FloatArray) -> tuple[float, float, float, float]:
    """External forces on shaft and housing, x and y [N]."""
    row = FORCES * LANES + lane
    wx, wy = params[row], params[row + LANES]
    if not len(shape.forced):
        return wx, wy, 0.0, 0.0
    return (
        wx + params[row + 4 * LANES] * half_step,
        wy + params[row + 5 * LANES] * half_step,
        params[row + 2 * LANES] + params[row + 6 * LANES] * half_step,
        params[row + 3 * LANES] + params[row + 7 * LANES] * half_step,
    )


@njit(**INLINE)
def accelerations(
    shape: Shape, q: tuple[float, ...], turn: Motion, half_step: int, lane: int, params: FloatArray
) -> tuple[float, float, float, float, float, float, float]:
    """Accelerations of the three bodies [m s-2], and the sum of powers; ``turn`` holds the directions of cage and shaft."""
    x1, y1, x2, y2, xr, yr, u1, v1, u2, v2, ur, vr = q
    c, s, shaft_c, shaft_s = turn
    dx, dy, du, dv = x1 - x2, y1 - y2, u1 - u2, v1 - v2
    fx, fy, powers = contact_force(shape, (dx, dy, du, dv), c, s, half_step, lane, params)
    c1, c0, k0 = params[C1 * LANES + lane], params[C0 * LANES + lane], params[K0 * LANES + lane]
    jx = fx + c1 * du + params[K1X * LANES + lane] * dx
    jy = fy + c1 * dv + params[K1Y * LANES + lane] * dy
    p, q_ = params[UNBALANCE_P * LANES + lane], params[UNBALANCE_Q * LANES + lane]
    wx, wy, hx, hy = forces(shape, half_step, lane, params)
    f1x = wx + (p * shaft_c + q_ * shaft_s) - jx - c0 * u1 - k0 * x1
    f1y = wy + (p * shaft_s - q_ * shaft_c) - jy - c0 * v1 - k0 * y1
    sx, sy = x2, y2
    if len(shape.loose):
        play = params[LOOSENESS * LANES + lane]
        sx, sy = x2 - min(max(x2, -play), play), y2 - min(max(y2, -play), play)
    f2x = jx + hx - params[C2X * LANES + lane] * u2 - params[K2X * LANES + lane] * sx
    f2y = jy + hy - params[C2Y * LANES + lane] * v2 - params[K2Y * LANES + lane] * sy
    arx = ary = 0.0
    if len(shape.resonator):
        cr, imr = params[CR * LANES + lane], params[IMR * LANES + lane]
        rx = params[KRX * LANES + lane] * (x2 - xr) + cr * (u2 - ur)
        ry = params[KRY * LANES + lane] * (y2 - yr) + cr * (v2 - vr)
        f2x, f2y, arx, ary = f2x - rx, f2y - ry, rx * imr, ry * imr
    im1, im2 = params[IM1 * LANES + lane], params[IM2 * LANES + lane]
    return f1x * im1, f1y * im1, f2x * im2, f2y * im2, arx, ary, powers


@njit(**INLINE)
def moved(q: tuple[float, ...], p: tuple[float, ...], a: tuple[float, ...], h: float) -> tuple[float, ...]:
    """State after ``h`` seconds at rates ``p`` and accelerations ``a``."""
    return (
        q[0] + h * p[0], q[1] + h * p[1], q[2] + h * p[2], q[3] + h * p[3], q[4] + h * p[4], q[5] + h * p[5],
        q[6] + h * a[0], q[7] + h * a[1], q[8] + h * a[2], q[9] + h * a[3], q[10] + h * a[4], q[11] + h * a[5],
    )  # fmt: skip


@njit(**INLINE)
def simpson(
    a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...], d: tuple[float, ...]
) -> tuple[float, ...]:
    """Runge-Kutta mean of the slopes of the four stages."""
    return (
        (a[0] + 2 * (b[0] + c[0]) + d[0]) * (1 / 6), (a[1] + 2 * (b[1] + c[1]) + d[1]) * (1 / 6),
        (a[2] + 2 * (b[2] + c[2]) + d[2]) * (1 / 6), (a[3] + 2 * (b[3] + c[3]) + d[3]) * (1 / 6),
        (a[4] + 2 * (b[4] + c[4]) + d[4]) * (1 / 6), (a[5] + 2 * (b[5] + c[5]) + d[5]) * (1 / 6),
    )  # fmt: skip


@njit(**INLINE)
def half_turn(turn: Motion, lane: int, params: FloatArray) -> Motion:
    """Directions of cage and shaft half a step later."""
    c, s, shaft_c, shaft_s = turn
    dc, ds = params[CAGE_TURN_C * LANES + lane], params[CAGE_TURN_S * LANES + lane]
    pc, ps = params[SHAFT_TURN_C * LANES + lane], params[SHAFT_TURN_S * LANES + lane]
    return c * dc - s * ds, s * dc + c * ds, shaft_c * pc - shaft_s * ps, shaft_s * pc + shaft_c * ps


@njit(**INLINE)
def advance(
    shape: Shape, state: FloatArray, params: FloatArray, dt: float, n_steps: int, history: FloatArray, at: int
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
    history : array, shape (step * channel * LANES + lane)
        Receives, from row ``at`` on, what is picked up at the start of each step [m s-2, or m].
    at : int
        First row of ``history`` to fill.
    """
    n_channels = len(shape.channels)
    for step in range(n_steps):
        half_step = 2 * step
        for lane in range(LANES):
            q = (
                state[lane], state[LANES + lane], state[2 * LANES + lane], state[3 * LANES + lane],
                state[4 * LANES + lane], state[5 * LANES + lane], state[6 * LANES + lane], state[7 * LANES + lane],
                state[8 * LANES + lane], state[9 * LANES + lane], state[10 * LANES + lane], state[11 * LANES + lane],
            )  # fmt: skip
            turn = (
                state[CAGE_C * LANES + lane], state[CAGE_S * LANES + lane],
                state[SHAFT_C * LANES + lane], state[SHAFT_S * LANES + lane],
            )  # fmt: skip
            a1 = accelerations(shape, q, turn, half_step, lane, params)
            turn = half_turn(turn, lane, params)
            q2 = moved(q, q[6:], a1, 0.5 * dt)
            a2 = accelerations(shape, q2, turn, half_step + 1, lane, params)
            q3 = moved(q, q2[6:], a2, 0.5 * dt)
            a3 = accelerations(shape, q3, turn, half_step + 1, lane, params)
            turn = half_turn(turn, lane, params)
            q4 = moved(q, q3[6:], a3, dt)
            a4 = accelerations(shape, q4, turn, half_step + 2, lane, params)
            new = moved(q, simpson(q[6:], q2[6:], q3[6:], q4[6:]), simpson(a1, a2, a3, a4), dt)
            for row in range(N_DYNAMIC):
                state[row * LANES + lane] = new[row]
            for row in range(4):
                state[(CAGE_C + row) * LANES + lane] = turn[row]
            state[STEEPEST * LANES + lane] = max(state[STEEPEST * LANES + lane], a1[6])
            for axis in range(AXES):
                state[(PICKED + axis) * LANES + lane] = q[axis] if len(shape.displacement) else a1[axis]
        for channel in range(n_channels):
            row = at + step * n_channels + channel
            for lane in range(LANES):
                value = 0.0
                for axis in range(AXES):
                    weight = params[(PICKUPS + channel * AXES + axis) * LANES + lane]
                    value += weight * state[(PICKED + axis) * LANES + lane]
                history[row * LANES + lane] = value
