"""The equations of motion of shaft, housing and sensor, lane by lane.

A lane holds one record. Between two knots (one per output sample) every slow quantity moves along a straight line: cage and shaft turn
at a constant rate, ball gaps, ball directions and spall offsets are linear in time.

Body 1 is the shaft with the inner ring, 2 the housing with the outer ring, r the sensor on its resonance. Balls push along their own
direction in the frame of the cage, in which they stand still but for their jitter. The system is that of Ophel et al. with its signs
and reactions corrected, plus a sensor mass: Lagrange's equations of the energies in docs/model.md.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gen.physics.kernel.compiling import CALLED, INLINE, LANES, fma, square_root

FloatArray = NDArray[np.float64]

MAX_BALLS = 24
_COUNT, _BALL = np.maximum(np.arange(MAX_BALLS + 1), 1)[:, None], np.arange(MAX_BALLS)
_ANGLE = (
    2 * np.pi * np.where(2 * _BALL > _COUNT, _BALL - _COUNT, _BALL) / _COUNT
)  # so that cosines of mirror images are the same bits
COS, SIN = np.cos(_ANGLE), np.sin(_ANGLE)  # (number of balls, ball): direction in the cage's frame

AXES = 6
# Rows of ``state``: coordinates x1 y1 x2 y2 xr yr, their rates, the directions of cage and shaft, the largest sum over all balls of
# the slope of ``squeeze**n / n`` so far (it bounds the contact stiffness); then, of the step under way, where it began and the weighted
# sum of its slopes.
N_DYNAMIC = 2 * AXES
CAGE_C, CAGE_S, SHAFT_C, SHAFT_S, STEEPEST, BEGINNING = range(N_DYNAMIC, N_DYNAMIC + 6)
SLOPES = BEGINNING + N_DYNAMIC
N_STATE = SLOPES + N_DYNAMIC
# Rows of ``params``: constants of the record, what holds until the next knot (forces with their slopes per half step), the weights of
# the pickups, direction of each ball in its pocket and gap under it with their slopes, and what spalls add to the gap at every half step.
# The contact damping is that of a ball over its load-deflection factor, which multiplies the sum over all balls.
(
    STIFFNESS, DAMPING, COSA, GAP, IM1, IM2, IMR, C1, C0, K0, K1X, K1Y, K2X, K2Y, C2X, C2Y, KRX, KRY, CR, LOOSENESS, N_CONSTANTS,
) = range(21)  # fmt: skip
(
    CAGE_TURN_C, CAGE_TURN_S, SHAFT_TURN_C, SHAFT_TURN_S, UNBALANCE_P, UNBALANCE_Q, FORCES, N_HELD,
) = (*range(N_CONSTANTS, N_CONSTANTS + 7), N_CONSTANTS + 6 + 8)  # fmt: skip
PICKUPS = N_HELD

Motion = tuple[float, float, float, float]
Push = tuple[float, float, float]
"""Force along the axes of the cage's frame, over the load-deflection factor of a ball, and squeeze to the power ``n - 1``."""


class Shape(NamedTuple):
    """What a compiled kernel contains, as lengths of tuples (see :mod:`gen.physics.kernel.compiling`); a record pays for nothing else."""

    balls: tuple[None, ...]
    channels: tuple[None, ...]
    displacement: tuple[None, ...]
    """Whether channels pick up displacements instead of accelerations."""
    resonator: tuple[None, ...]
    damped: tuple[None, ...]
    wavy: tuple[None, ...]
    """Whether races or balls are wavy, so that gaps change from knot to knot."""
    spalled: tuple[None, ...]
    """Whether balls may drop into spalls."""
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


@njit(**CALLED)
def direction_row(shape: Shape) -> int:
    """First row of the directions of jittered balls in ``params``: cosine and sine, then their slopes per half step, of each ball."""
    return PICKUPS + len(shape.channels) * AXES


@njit(**CALLED)
def gap_row(shape: Shape) -> int:
    """First row of the gaps in ``params``: gap and its slope per half step, of each ball."""
    return direction_row(shape) + (4 * len(shape.balls) if len(shape.jittered) else 0)


@njit(**CALLED)
def drop_row(shape: Shape) -> int:
    """First row of the drops into spalls in ``params``: half step after half step, every ball of each."""
    return gap_row(shape) + (2 * len(shape.balls) if len(shape.wavy) else 0)


@njit(**CALLED)
def param_rows(shape: Shape, n_steps: int) -> int:
    """Number of rows of ``params``."""
    return drop_row(shape) + ((2 * n_steps + 1) * len(shape.balls) if len(shape.spalled) else 0)


@njit(**INLINE)
def ninth_root(x: float) -> float:
    """Ninth root, to 1e-13 between 1e-11 and 1e-3: Halley's steps from the eighth root, which square roots give.

    Between those the ninth root is 1.08 to 1.42 times the eighth.
    """
    y = 1.25 * square_root(square_root(square_root(x))) + 1e-300
    for _ in range(3):
        cube = y * y * y
        ninth = cube * cube * cube
        y *= fma(8.0, ninth, 10 * x) / (fma(10.0, ninth, 8 * x) + 1e-300)
    return y


class Instant(NamedTuple):
    """A place in the time between two knots."""

    half_step: float
    """Half steps since the last knot."""
    since: float
    """Half steps since the directions of the balls were laid down."""
    drops: FloatArray
    """Drop of each ball into spalls, shape (ball * LANES + lane) [m]."""


@njit(**INLINE)
def add_ball(
    shape: Shape, ball: int | np.int64, total: Push, motion: Motion, instant: Instant, lane: int, params: FloatArray
) -> Push:
    """Add the push of one ball to a sum."""
    if ball >= len(shape.balls):
        return total
    x, y, u, v = motion
    c, s = COS[len(shape.balls), ball], SIN[len(shape.balls), ball]
    if len(shape.jittered):
        row = (direction_row(shape) + 4 * ball) * LANES + lane
        c = fma(params[row + 2 * LANES], instant.since, params[row])
        s = fma(params[row + 3 * LANES], instant.since, params[row + LANES])
    gap = params[GAP * LANES + lane]
    if len(shape.wavy):
        row = (gap_row(shape) + 2 * ball) * LANES + lane
        gap = fma(params[row + LANES], instant.half_step, params[row])
    # in this order a ball and its mirror image share the inner part if their gaps are the same
    squeeze = fma(x, c, -gap)
    ahead = ball == 0 and len(shape.jittered) == 0  # in the direction of the cage: its sine is zero
    if not ahead:
        squeeze = fma(y, s, squeeze)
    if len(shape.spalled):
        squeeze -= instant.drops[ball * LANES + lane]
    squeeze = max(squeeze, 0.0)
    if len(shape.roller):
        power = ninth_root(squeeze)
    elif ball % 4 == 3:  # the divider, which would lie idle, takes some of the roots: 8 % of the time of a step
        power = math.sqrt(squeeze)
    else:
        power = square_root(squeeze)
    force = squeeze * power
    if len(shape.damped):
        damped = max(fma(params[DAMPING * LANES + lane], fma(u, c, v * s), force), 0.0)
        force = damped if squeeze > 0.0 else 0.0
    along, across, powers = total
    return fma(force, c, along), across if ahead else fma(force, s, across), powers + power


@njit(**INLINE)
def add_four(
    shape: Shape,
    first: int | np.int64,
    totals: tuple[Push, ...],
    motion: Motion,
    instant: Instant,
    lane: int,
    params: FloatArray,
) -> tuple[Push, ...]:
    """Add four balls to four sums; a loop over balls would not be unrolled before LLVM looks at the loop over lanes."""
    return (
        add_ball(shape, first, totals[0], motion, instant, lane, params),
        add_ball(shape, first + 1, totals[1], motion, instant, lane, params),
        add_ball(shape, first + 2, totals[2], motion, instant, lane, params),
        add_ball(shape, first + 3, totals[3], motion, instant, lane, params),
    )


@njit(**INLINE)
def contact_force(
    shape: Shape, motion: Motion, c: float, s: float, instant: Instant, lane: int, params: FloatArray
) -> Push:
    """Force that all balls together put on the housing, and its reaction on the shaft, x and y [N], and the sum of their powers.

    ``motion`` is displacement and velocity of the shaft relative to the housing; ``c`` and ``s`` are the direction of the cage.
    """
    cosa = params[COSA * LANES + lane]
    x, y, u, v = motion
    c, s = cosa * c, cosa * s
    seen = (fma(x, c, y * s), fma(y, c, -(x * s)), fma(u, c, v * s), fma(v, c, -(u * s)))
    nothing = (-0.0, -0.0, -0.0)  # to add it takes no instruction: it leaves zeros their sign
    sums = (nothing, nothing, nothing, nothing)
    # numbers that numba does not take for types: it would compile the four balls once for each
    sums = add_four(shape, np.int64(0), sums, seen, instant, lane, params)
    sums = add_four(shape, np.int64(4), sums, seen, instant, lane, params)
    sums = add_four(shape, np.int64(8), sums, seen, instant, lane, params)
    sums = add_four(shape, np.int64(12), sums, seen, instant, lane, params)
    sums = add_four(shape, np.int64(16), sums, seen, instant, lane, params)
    sums = add_four(shape, np.int64(20), sums, seen, instant, lane, params)
    (ax, ay, ap), (bx, by, bp), (cx, cy, cp), (dx, dy, dp) = sums
    stiffness = params[STIFFNESS * LANES + lane]
    along, across = stiffness * ((ax + bx) + (cx + dx)), stiffness * ((ay + by) + (cy + dy))
    return fma(along, c, -(across * s)), fma(along, s, across * c), (ap + bp) + (cp + dp)


@njit(**INLINE)
def forces(shape: Shape, half_step: float, lane: int, params: FloatArray) -> tuple[float, float, float, float]:
    """External forces on shaft and housing, x and y [N]."""
    row = FORCES * LANES + lane
    wx, wy = params[row], params[row + LANES]
    if not len(shape.forced):
        return wx, wy, 0.0, 0.0
    return (
        fma(params[row + 4 * LANES], half_step, wx),
        fma(params[row + 5 * LANES], half_step, wy),
        fma(params[row + 6 * LANES], half_step, params[row + 2 * LANES]),
        fma(params[row + 7 * LANES], half_step, params[row + 3 * LANES]),
    )


@njit(**INLINE)
def accelerations(
    shape: Shape, q: tuple[float, ...], turn: Motion, instant: Instant, lane: int, params: FloatArray
) -> tuple[float, float, float, float, float, float, float]:
    """Accelerations of the three bodies [m s-2], and the sum of powers; ``turn`` holds the directions of cage and shaft."""
    x1, y1, x2, y2, xr, yr, u1, v1, u2, v2, ur, vr = q
    c, s, shaft_c, shaft_s = turn
    dx, dy, du, dv = x1 - x2, y1 - y2, u1 - u2, v1 - v2
    fx, fy, powers = contact_force(shape, (dx, dy, du, dv), c, s, instant, lane, params)
    c1, c0, k0 = params[C1 * LANES + lane], params[C0 * LANES + lane], params[K0 * LANES + lane]
    jx = fma(params[K1X * LANES + lane], dx, fma(c1, du, fx))
    jy = fma(params[K1Y * LANES + lane], dy, fma(c1, dv, fy))
    p, q_ = params[UNBALANCE_P * LANES + lane], params[UNBALANCE_Q * LANES + lane]
    wx, wy, hx, hy = forces(shape, instant.half_step, lane, params)
    f1x = fma(-k0, x1, fma(-c0, u1, fma(p, shaft_c, fma(q_, shaft_s, wx)) - jx))
    f1y = fma(-k0, y1, fma(-c0, v1, fma(p, shaft_s, fma(-q_, shaft_c, wy)) - jy))
    sx, sy = x2, y2
    if len(shape.loose):
        play = params[LOOSENESS * LANES + lane]
        sx, sy = x2 - min(max(x2, -play), play), y2 - min(max(y2, -play), play)
    f2x = fma(-params[K2X * LANES + lane], sx, fma(-params[C2X * LANES + lane], u2, jx))
    f2y = fma(-params[K2Y * LANES + lane], sy, fma(-params[C2Y * LANES + lane], v2, jy))
    if len(shape.forced):
        f2x, f2y = f2x + hx, f2y + hy
    arx = ary = 0.0
    if len(shape.resonator):
        cr, imr = params[CR * LANES + lane], params[IMR * LANES + lane]
        rx = fma(params[KRX * LANES + lane], x2 - xr, cr * (u2 - ur))
        ry = fma(params[KRY * LANES + lane], y2 - yr, cr * (v2 - vr))
        f2x, f2y, arx, ary = f2x - rx, f2y - ry, rx * imr, ry * imr
    im1, im2 = params[IM1 * LANES + lane], params[IM2 * LANES + lane]
    return f1x * im1, f1y * im1, f2x * im2, f2y * im2, arx, ary, powers
