"""Squeeze of the balls by an axial load.

If the inner ring moves by ``axial`` along the axis, every ball is squeezed by ``axial * sin(contact_angle)`` more. In equilibrium the
axial components of all ball forces add up to the axial load, and the radial components to the radial load. The contact angle is
constant. A radial load pushes the rings apart: with an axial load below about ``1.25 * radial load * tan(contact_angle)`` fewer than
half of the balls are loaded, and the bearing has no stable axial position [1]_.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 7, combined radial and thrust load.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.elementary import power
from gen.physics.rotor import Machine, solve
from gen.support.rounding import rounded_up

FloatArray = NDArray[np.float64]
# least axial load, over radial load times the tangent of the contact angle, at which half of the balls are loaded
HALF_LOADED = 1.25
_BALANCED = 1e-9  # largest unbalanced force over the load
_MOST_STEPS, _SMALLEST_SHARE, _ROUNDING = 100, 1e-3, 1e-12


def least_axial_load(radial_load: float, contact_angle: float) -> float:
    """Axial load at which half of the balls are loaded [N]; a smaller one does not hold the rings together.

    >>> round(least_axial_load(1000.0, np.radians(15)))
    335
    """
    return HALF_LOADED * radial_load * math.tan(abs(contact_angle))  # that of NumPy has other bits on other processors


def check_axial_load(machine: Machine, axial_load: float, largest_load_share: float = 1.0) -> None:
    """Raise ValueError if the contact angle is 0, or if an axial load [N] is too small to load half of the balls.

    It must suffice for ``largest_load_share`` times the radial load of ``machine``.
    """
    cosine = machine.contact_cosine
    sine = np.sqrt(1 - cosine**2)
    least = HALF_LOADED * largest_load_share * np.hypot(machine.load_x, machine.load_y) * sine / cosine
    if sine == 0:
        message = f"an axial load of {axial_load:g} N needs a contact angle above 0."
        raise ValueError(message)
    if axial_load < least:
        message = f"an axial load of {axial_load:.4g} N is too small to hold its rings together; give at least {rounded_up(least)} N."
        raise ValueError(message)


def axial_approach(machine: Machine, axial_load: FloatArray, angles: FloatArray) -> list[float]:
    """Squeeze that an axial load adds to every ball, of each record [m].

    Parameters
    ----------
    machine : Machine
        Arrays of shape (record,): radial load, clearance, contact angle and load-deflection law are used. All records have the same
        ``contact_exponent``.
    axial_load : array, shape (record,)
        Those that :func:`check_axial_load` allows [N].
    angles : array, shape (record, ball)
        Angular positions of the balls, NaN for balls that a bearing does not have [rad].
    """
    cosine, factor, n = machine.contact_cosine, machine.load_deflection_factor, machine.contact_exponent
    missing, sine = np.isnan(angles.T), np.sqrt(1 - np.square(cosine))
    directions = np.stack([cosine * np.cos(angles).T, cosine * np.sin(angles).T, np.broadcast_to(sine, missing.shape)])
    balls = _Balls(
        directions=np.where(missing, 0.0, directions),
        load=np.stack([machine.load_x, machine.load_y, axial_load]),
        factor=np.asarray(factor),
        exponent=np.asarray(n),
        half_clearance=np.where(missing, np.inf, machine.half_clearance),  # never squeezed
    )
    # every ball carries the same part of the axial load
    equal_squeeze = power(axial_load / (np.count_nonzero(~missing, axis=0) * sine * factor), 1 / balls.exponent)
    start = np.zeros((3, len(angles)))
    start[2] = (np.maximum(machine.half_clearance, 0.0) + equal_squeeze) / sine
    # rounded to a picometre: the powers of C libraries may differ in the last bit
    return [round(squeeze, 12) for squeeze in (_equilibrium(balls, start)[2] * sine).tolist()]


class _Balls(NamedTuple):
    """Balls of some records; the last axis of every array is the record."""

    directions: FloatArray
    """Shape (axis, ball, record)."""
    load: FloatArray
    """Shape (axis, record)."""
    factor: FloatArray
    exponent: FloatArray
    half_clearance: FloatArray
    """Shape (ball, record)."""

    def squeeze(self, q: FloatArray) -> FloatArray:
        """Squeeze of every ball under a displacement, shape (ball, record)."""
        x, y, z = self.directions
        return np.maximum(x * q[0] + y * q[1] + z * q[2] - self.half_clearance, 0.0)

    def energy(self, squeeze: FloatArray, q: FloatArray) -> FloatArray:
        """Potential energy, shape (record,)."""
        stored = _sum(squeeze * squeeze * power(squeeze, self.exponent - 1))
        return self.factor / (self.exponent + 1) * stored - _sum(self.load * q)


def _sum(terms: FloatArray) -> FloatArray:
    """Sum over the last axis but one, term by term; the order of NumPy's sum would depend on the number of records."""
    return np.add.accumulate(terms, axis=-2)[..., -1, :]


def _equilibrium(balls: _Balls, start: FloatArray) -> FloatArray:
    """Displacement of the inner ring at which the forces of the balls balance the loads, shape (axis, record) [m].

    Newton steps down the potential energy, which is convex; a step that raises it is halved. Converged records are frozen.
    """
    places = np.arange(start.shape[1], dtype=np.intp)
    equilibrium, q = start.copy(), start
    for _ in range(_MOST_STEPS):
        squeeze = balls.squeeze(q)
        root = power(squeeze, balls.exponent - 1)
        residual = balls.load - _sum(balls.factor * squeeze * root * balls.directions)
        moving = np.abs(residual).max(axis=0) >= _BALANCED * np.abs(balls.load).max(axis=0)
        if not moving.all():
            equilibrium[:, places[~moving]] = q[:, ~moving]
            balls = _Balls(*(array[..., moving] for array in balls))
            places, q, squeeze = places[moving], q[:, moving], squeeze[:, moving]
            root, residual = root[:, moving], residual[:, moving]
        if not len(places):
            break
        stiff = balls.exponent * balls.factor * root * balls.directions
        step = solve(_sum(stiff[:, None] * balls.directions), residual)
        q = _lower_energy(balls, q, step, balls.energy(squeeze, q))
    equilibrium[:, places] = q
    return equilibrium


def _lower_energy(balls: _Balls, q: FloatArray, step: FloatArray, before: FloatArray) -> FloatArray:
    """Displacements after a step, or after a share of it that does not raise the energy above ``before``, shape (axis, record) [m]."""
    share, before = np.ones(q.shape[1]), before + _ROUNDING * np.abs(before)
    while True:
        moved = q + share * step
        again = (balls.energy(balls.squeeze(moved), moved) > before) & (share >= _SMALLEST_SHARE)
        if not again.any():
            return moved
        share = np.where(again, share / 2, share)
