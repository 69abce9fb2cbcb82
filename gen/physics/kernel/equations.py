"""The equations of motion of shaft, housing and sensor, lane by lane.

A lane holds one record. Between two knots (one per output sample) cage and shaft turn at a constant rate, and ball gaps, ball directions
and outer forces change linearly with time.

Body 1 is the shaft with the inner ring, 2 the housing with the outer ring, r the sensor mass on its resonance. The system is that of
Ophel et al. with its signs and reactions corrected, plus a sensor mass: Lagrange's equations of the energies in docs/model.md. The same
equations in plain NumPy, one record at a time, are in ``tests/reference.py``.
"""

from numba import njit

from gen.physics.kernel.compiling import INLINE, LANES, fma
from gen.physics.kernel.layout import FloatArray, Param, State


@njit(**INLINE)
def contact_force(state: FloatArray, params: FloatArray, lane: int) -> tuple[float, float]:
    """Force ``(Fx, Fy)`` of all balls on the housing [N]; the shaft takes ``(-Fx, -Fy)``.

    It is turned back from the frame of the cage, see :mod:`gen.physics.kernel.contacts`::

        F = K cos(alpha) sum over balls of force * direction
    """
    factor = params[Param.CONTACT_COSINE * LANES + lane] * params[Param.LOAD_DEFLECTION_FACTOR * LANES + lane]
    c, s = state[State.CAGE_COS * LANES + lane], state[State.CAGE_SIN * LANES + lane]
    i = State.PUSH * LANES + lane
    along, across = factor * state[i], factor * state[i + LANES]
    return fma(along, c, -(across * s)), fma(along, s, across * c)


@njit(**INLINE)
def forces(half_step: float, params: FloatArray, lane: int) -> tuple[float, float, float, float]:
    """Outer forces on shaft and housing, x and y of each, so many half steps after the knot [N]."""
    i = Param.SHAFT_FORCE_X * LANES + lane
    slope = Param.SHAFT_FORCE_X_SLOPE * LANES + lane
    return (
        fma(params[slope], half_step, params[i]),
        fma(params[slope + LANES], half_step, params[i + LANES]),
        fma(params[slope + 2 * LANES], half_step, params[i + 2 * LANES]),
        fma(params[slope + 3 * LANES], half_step, params[i + 3 * LANES]),
    )


@njit(**INLINE)
def accelerations(
    q: tuple[float, ...], half_step: float, state: FloatArray, params: FloatArray, lane: int
) -> tuple[float, float, float, float, float, float]:
    """Accelerations of the three bodies [m s-2].

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
    shaft_c, shaft_s = state[State.SHAFT_COS * LANES + lane], state[State.SHAFT_SIN * LANES + lane]
    fx, fy = contact_force(state, params, lane)
    c1, c0 = params[Param.RING_DAMPING * LANES + lane], params[Param.SHAFT_DAMPING * LANES + lane]
    k0 = params[Param.SHAFT_STIFFNESS * LANES + lane]
    jx = fma(params[Param.RING_STIFFNESS_X * LANES + lane], x1 - x2, fma(c1, u1 - u2, fx))
    jy = fma(params[Param.RING_STIFFNESS_Y * LANES + lane], y1 - y2, fma(c1, v1 - v2, fy))
    p, t = params[Param.UNBALANCE_RADIAL * LANES + lane], params[Param.UNBALANCE_TANGENTIAL * LANES + lane]
    wx, wy, hx, hy = forces(half_step, params, lane)
    f1x = fma(-k0, x1, fma(-c0, u1, fma(p, shaft_c, fma(t, shaft_s, wx)) - jx))
    f1y = fma(-k0, y1, fma(-c0, v1, fma(p, shaft_s, fma(-t, shaft_c, wy)) - jy))
    play = params[Param.LOOSENESS * LANES + lane]
    sx, sy = x2 - min(max(x2, -play), play), y2 - min(max(y2, -play), play)
    k2x, k2y = params[Param.SUPPORT_STIFFNESS_X * LANES + lane], params[Param.SUPPORT_STIFFNESS_Y * LANES + lane]
    c2x, c2y = params[Param.SUPPORT_DAMPING_X * LANES + lane], params[Param.SUPPORT_DAMPING_Y * LANES + lane]
    cr, imr = params[Param.SENSOR_DAMPING * LANES + lane], params[Param.PER_SENSOR_MASS * LANES + lane]
    rx = fma(params[Param.SENSOR_STIFFNESS_X * LANES + lane], x2 - xr, cr * (u2 - ur))
    ry = fma(params[Param.SENSOR_STIFFNESS_Y * LANES + lane], y2 - yr, cr * (v2 - vr))
    f2x = fma(-k2x, sx, fma(-c2x, u2, jx)) + hx - rx
    f2y = fma(-k2y, sy, fma(-c2y, v2, jy)) + hy - ry
    im1, im2 = params[Param.PER_SHAFT_MASS * LANES + lane], params[Param.PER_HOUSING_MASS * LANES + lane]
    return f1x * im1, f1y * im1, f2x * im2, f2y * im2, rx * imr, ry * imr
