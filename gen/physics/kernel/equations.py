"""The equations of motion of shaft, housing and sensor, lane by lane.

A lane holds one record. Between two knots (one per output sample) cage and shaft turn at a constant rate, and ball gaps, ball directions
and outer forces change linearly with time.

Body 1 is the shaft with the inner ring, 2 the housing with the outer ring, r the sensor mass on its resonance. The system is that of
Ophel et al. with its signs and reactions corrected, plus a sensor mass: Lagrange's equations of the energies in docs/model.md. The same
equations in plain NumPy, one record at a time, are in ``tests/reference.py``.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.extent import MAX_BALLS
from gen.physics.kernel.compiling import INLINE, LANES, fma, root
from gen.physics.kernel.layout import FloatArray, Param, Shape, direction_row, gap_row

_COUNT, _BALL = np.maximum(np.arange(MAX_BALLS + 1), 1)[:, None], np.arange(MAX_BALLS)
# angles counted from -pi to pi, so that the cosines of mirror images have the same bits
_ANGLE = 2 * np.pi * np.where(2 * _BALL > _COUNT, _BALL - _COUNT, _BALL) / _COUNT
COS, SIN = np.cos(_ANGLE), np.sin(_ANGLE)  # (number of balls, ball): direction in the cage's frame

Relative = tuple[float, float, float, float]
"""Displacement and velocity of the shaft relative to the housing: x, y [m], x', y' [m/s]."""
Directions = tuple[float, float, float, float]
"""Cosine and sine of the angle of the cage, then of the shaft."""
Push = tuple[float, float, float]
"""Force along and across the direction of the cage, over K, and the sum of ``squeeze**(n - 1)``."""


@njit(**INLINE)
def ninth_root(x: float) -> float:
    """Ninth root, to 1e-13 of its value between 1e-11 and 1e-3.

    Three steps of Halley's method start from 1.25 times the eighth root, which is three square roots: over that range the ninth root is
    1.08 to 1.42 times the eighth.
    """
    y = 1.25 * root(root(root(x))) + 1e-300
    for _ in range(3):
        cube = y * y * y
        ninth = cube * cube * cube
        y *= fma(8.0, ninth, 10 * x) / (fma(10.0, ninth, 8 * x) + 1e-300)
    return y


class Instant(NamedTuple):
    """A time between two knots, and the drops of the balls at it."""

    half_step: float
    """Half steps since the last knot."""
    since: float
    """Half steps since the directions of the balls were last computed."""
    drops: FloatArray
    """Drop of each ball into spalls [m], shape (ball * LANES + lane)."""


@njit(**INLINE)
def add_ball(
    shape: Shape, ball: int | np.int64, total: Push, motion: Relative, instant: Instant, lane: int, params: FloatArray
) -> Push:
    """Add the force of one ball to a sum, in the frame of the cage.

    With the direction ``(c, s)`` of the ball, its squeeze and its force over K are::

        squeeze = x c + y s - gap - drop
        force   = squeeze**n  (+ c_b / K (x' c + y' s) while squeeze > 0, never below 0)        n = 3/2 for balls, 10/9 for rollers
    """
    if ball >= len(shape.balls):
        return total
    x, y, u, v = motion
    c, s = COS[len(shape.balls), ball], SIN[len(shape.balls), ball]
    if len(shape.jittered):
        row = (direction_row(shape) + 4 * ball) * LANES + lane
        c = fma(params[row + 2 * LANES], instant.since, params[row])
        s = fma(params[row + 3 * LANES], instant.since, params[row + LANES])
    gap = params[Param.HALF_CLEARANCE * LANES + lane]
    if len(shape.wavy):
        row = (gap_row(shape) + 2 * ball) * LANES + lane
        gap = fma(params[row + LANES], instant.half_step, params[row])
    # in this order LLVM computes the inner part once for a ball and its mirror image if their gaps are the same
    squeeze = fma(x, c, -gap)
    ahead = ball == 0 and len(shape.jittered) == 0  # ball 0 lies in the direction of the cage: its sine is zero
    if not ahead:
        squeeze = fma(y, s, squeeze)
    if len(shape.spalled):
        squeeze -= instant.drops[ball * LANES + lane]
    squeeze = max(squeeze, 0.0)
    if len(shape.roller):
        power = ninth_root(squeeze)
    elif ball % 4 < 2 and ball + 1 < len(shape.balls):  # a slow divider computes these beside the others
        power = math.sqrt(squeeze)
    else:
        power = root(squeeze)
    force = squeeze * power
    if len(shape.damped):
        damped = max(fma(params[Param.CONTACT_DAMPING * LANES + lane], fma(u, c, v * s), force), 0.0)
        force = damped if squeeze > 0.0 else 0.0
    along, across, powers = total
    return fma(force, c, along), across if ahead else fma(force, s, across), powers + power


@njit(**INLINE)
def add_four(
    shape: Shape,
    first: int | np.int64,
    totals: tuple[Push, ...],
    motion: Relative,
    instant: Instant,
    lane: int,
    params: FloatArray,
) -> tuple[Push, ...]:
    """Add four balls to four sums; LLVM would vectorise the loop over lanes before it unrolled a loop over balls."""
    return (
        add_ball(shape, first, totals[0], motion, instant, lane, params),
        add_ball(shape, first + 1, totals[1], motion, instant, lane, params),
        add_ball(shape, first + 2, totals[2], motion, instant, lane, params),
        add_ball(shape, first + 3, totals[3], motion, instant, lane, params),
    )


@njit(**INLINE)
def add_sixteen(
    shape: Shape,
    first: int | np.int64,
    totals: tuple[Push, ...],
    motion: Relative,
    instant: Instant,
    lane: int,
    params: FloatArray,
) -> tuple[Push, ...]:
    """Add sixteen balls to four sums."""
    totals = add_four(shape, first, totals, motion, instant, lane, params)
    totals = add_four(shape, first + 4, totals, motion, instant, lane, params)
    totals = add_four(shape, first + 8, totals, motion, instant, lane, params)
    return add_four(shape, first + 12, totals, motion, instant, lane, params)


@njit(**INLINE)
def contact_force(
    shape: Shape, motion: Relative, c: float, s: float, instant: Instant, lane: int, params: FloatArray
) -> Push:
    """Force ``(Fx, Fy)`` of all balls on the housing [N], and the sum of ``squeeze**(n - 1)``; the shaft takes ``(-Fx, -Fy)``.

    ``motion`` is turned into the frame of the cage, whose direction is ``(c, s)``: there the balls stand still but for their jitter. Only
    the part along the contact angle alpha squeezes a ball::

        F = K cos(alpha) sum over balls of force * direction
    """
    cosa = params[Param.CONTACT_COSINE * LANES + lane]
    x, y, u, v = motion
    c, s = cosa * c, cosa * s
    seen = (fma(x, c, y * s), fma(y, c, -(x * s)), fma(u, c, v * s), fma(v, c, -(u * s)))
    nothing = (
        -0.0,
        -0.0,
        -0.0,
    )  # the exact additive identity, so LLVM drops the addition; 0.0 would change the sign of -0.0
    sums = (nothing, nothing, nothing, nothing)
    # np.int64, because numba would compile the function once for each plain integer
    sums = add_sixteen(shape, np.int64(0), sums, seen, instant, lane, params)
    sums = add_sixteen(shape, np.int64(16), sums, seen, instant, lane, params)
    sums = add_sixteen(shape, np.int64(32), sums, seen, instant, lane, params)
    sums = add_sixteen(shape, np.int64(48), sums, seen, instant, lane, params)  # up to MAX_BALLS
    (ax, ay, ap), (bx, by, bp), (cx, cy, cp), (dx, dy, dp) = sums
    stiffness = params[Param.LOAD_DEFLECTION_FACTOR * LANES + lane]
    along, across = stiffness * ((ax + bx) + (cx + dx)), stiffness * ((ay + by) + (cy + dy))
    return fma(along, c, -(across * s)), fma(along, s, across * c), (ap + bp) + (cp + dp)


@njit(**INLINE)
def forces(shape: Shape, instant: Instant, lane: int, params: FloatArray) -> tuple[float, float, float, float]:
    """Outer forces on shaft and housing, x and y of each [N]."""
    wx, wy = params[Param.SHAFT_FORCE_X * LANES + lane], params[Param.SHAFT_FORCE_Y * LANES + lane]
    hx = hy = 0.0
    if len(shape.forced):
        half_step = instant.half_step
        hx, hy = params[Param.HOUSING_FORCE_X * LANES + lane], params[Param.HOUSING_FORCE_Y * LANES + lane]
        wx = fma(params[Param.SHAFT_FORCE_X_SLOPE * LANES + lane], half_step, wx)
        wy = fma(params[Param.SHAFT_FORCE_Y_SLOPE * LANES + lane], half_step, wy)
        hx = fma(params[Param.HOUSING_FORCE_X_SLOPE * LANES + lane], half_step, hx)
        hy = fma(params[Param.HOUSING_FORCE_Y_SLOPE * LANES + lane], half_step, hy)
    return wx, wy, hx, hy


@njit(**INLINE)
def accelerations(
    shape: Shape, q: tuple[float, ...], directions: Directions, instant: Instant, lane: int, params: FloatArray
) -> tuple[float, float, float, float, float, float, float]:
    """Accelerations of the three bodies [m s-2], and the sum of ``squeeze**(n - 1)``.

    With the mark of the shaft in direction ``(cs, ss)``::

        m1 x1'' = Wx + p cs + q ss - Fx - c1 (x1' - x2') - k1x (x1 - x2) - c0 x1' - k0 x1
        m2 x2'' = Hx + Fx + c1 (x1' - x2') + k1x (x1 - x2) - c2x x2' - k2x g(x2) - krx (x2 - xr) - cr (x2' - xr')
        mr xr'' = krx (x2 - xr) + cr (x2' - xr')

    and the same in y, with ``p ss - q cs`` for the unbalance.

    =========== ================================================================ ====================
    symbol      meaning                                                          row of ``params``
    =========== ================================================================ ====================
    m1, m2, mr  masses of shaft, housing and sensor (their inverses are stored)  PER_SHAFT_MASS ...
    Fx          force of the balls on the housing, :func:`contact_force`         LOAD_DEFLECTION_FACTOR ...
    Wx, Hx      outer forces on shaft and housing, :func:`forces`                SHAFT_FORCE_X ...
    p, q        unbalance with bent shaft along the mark, and unbalance across   UNBALANCE_RADIAL,
                it while the speed changes                                       UNBALANCE_TANGENTIAL
    c1, k1      between shaft and housing: grease, seals, cage                   RING_DAMPING, RING_STIFFNESS_X
    c0, k0      between shaft and ground: its other bearing                      SHAFT_DAMPING, SHAFT_STIFFNESS
    c2, k2      support of the housing                                           SUPPORT_DAMPING_X, SUPPORT_STIFFNESS_X
    g           ``x - clip(x, -play, play)`` with a loose support, or ``x``      LOOSENESS
    cr, kr      sensor resonance                                                 SENSOR_DAMPING, SENSOR_STIFFNESS_X
    =========== ================================================================ ====================
    """
    x1, y1, x2, y2, xr, yr, u1, v1, u2, v2, ur, vr = q
    c, s, shaft_c, shaft_s = directions
    dx, dy, du, dv = x1 - x2, y1 - y2, u1 - u2, v1 - v2
    fx, fy, roots = contact_force(shape, (dx, dy, du, dv), c, s, instant, lane, params)
    c1, c0 = params[Param.RING_DAMPING * LANES + lane], params[Param.SHAFT_DAMPING * LANES + lane]
    k0 = params[Param.SHAFT_STIFFNESS * LANES + lane]
    jx = fma(params[Param.RING_STIFFNESS_X * LANES + lane], dx, fma(c1, du, fx))
    jy = fma(params[Param.RING_STIFFNESS_Y * LANES + lane], dy, fma(c1, dv, fy))
    p, t = params[Param.UNBALANCE_RADIAL * LANES + lane], params[Param.UNBALANCE_TANGENTIAL * LANES + lane]
    wx, wy, hx, hy = forces(shape, instant, lane, params)
    f1x = fma(-k0, x1, fma(-c0, u1, fma(p, shaft_c, fma(t, shaft_s, wx)) - jx))
    f1y = fma(-k0, y1, fma(-c0, v1, fma(p, shaft_s, fma(-t, shaft_c, wy)) - jy))
    sx, sy = x2, y2
    if len(shape.loose):
        play = params[Param.LOOSENESS * LANES + lane]
        sx, sy = x2 - min(max(x2, -play), play), y2 - min(max(y2, -play), play)
    k2x, k2y = params[Param.SUPPORT_STIFFNESS_X * LANES + lane], params[Param.SUPPORT_STIFFNESS_Y * LANES + lane]
    c2x, c2y = params[Param.SUPPORT_DAMPING_X * LANES + lane], params[Param.SUPPORT_DAMPING_Y * LANES + lane]
    f2x, f2y = fma(-k2x, sx, fma(-c2x, u2, jx)), fma(-k2y, sy, fma(-c2y, v2, jy))
    if len(shape.forced):
        f2x, f2y = f2x + hx, f2y + hy
    arx = ary = 0.0
    if len(shape.resonator):
        cr, imr = params[Param.SENSOR_DAMPING * LANES + lane], params[Param.PER_SENSOR_MASS * LANES + lane]
        rx = fma(params[Param.SENSOR_STIFFNESS_X * LANES + lane], x2 - xr, cr * (u2 - ur))
        ry = fma(params[Param.SENSOR_STIFFNESS_Y * LANES + lane], y2 - yr, cr * (v2 - vr))
        f2x, f2y, arx, ary = f2x - rx, f2y - ry, rx * imr, ry * imr
    im1, im2 = params[Param.PER_SHAFT_MASS * LANES + lane], params[Param.PER_HOUSING_MASS * LANES + lane]
    return f1x * im1, f1y * im1, f2x * im2, f2y * im2, arx, ary, roots
