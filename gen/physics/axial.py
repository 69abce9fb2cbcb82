"""Squeeze of the balls by an axial load.

If the inner ring moves by ``axial`` along the axis, every ball is squeezed by ``axial * sin(contact_angle)`` more. In equilibrium the
axial components of all ball forces add up to the axial load, and the radial components to the radial load. The contact angle is
constant. A radial load pushes the rings apart: with an axial load below about ``1.25 * radial load * tan(contact_angle)`` fewer than
half of the balls are loaded, and the bearing has no stable axial position [1]_.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 7, combined radial and thrust load.
"""

import numpy as np
from numpy.typing import NDArray

from gen.physics.rotor import Machine

FloatArray = NDArray[np.float64]
# least axial load, over radial load times the tangent of the contact angle, at which half of the balls are loaded
HALF_LOADED = 1.25
_BALANCED = 1e-9  # largest unbalanced force over the load
_MOST_STEPS, _SMALLEST_SHARE = 100, 1e-3


def least_axial_load(radial_load: float, contact_angle: float) -> float:
    """Axial load at which half of the balls are loaded [N]; a smaller one does not hold the rings together.

    >>> round(least_axial_load(1000.0, np.radians(15)))
    335
    """
    return float(HALF_LOADED * radial_load * np.tan(abs(contact_angle)))


def axial_approach(machine: Machine, axial_load: float, angles: FloatArray, largest_load_share: float = 1.0) -> float:
    """Squeeze that an axial load adds to every ball [m].

    Parameters
    ----------
    machine : Machine
        Its radial load, clearance, contact angle and load-deflection law are used.
    axial_load : float
        Above 0 [N].
    angles : array, shape (ball,)
        Angular positions of the balls [rad].
    largest_load_share : float
        Largest radial load of the record over the load of ``machine``; the axial load must suffice for it [1].

    Raises
    ------
    ValueError
        If the contact angle is 0, or if the axial load is too small to load half of the balls.
    """
    cosine = machine.contact_cosine
    sine = np.sqrt(1 - cosine**2)
    least = HALF_LOADED * largest_load_share * np.hypot(machine.load_x, machine.load_y) * sine / cosine
    if sine == 0 or axial_load < least:
        message = (
            f"an axial load of {axial_load:.4g} N is too small to hold its rings together; give at least {least:.4g} N."
        )
        if sine == 0:
            message = f"an axial load of {axial_load:g} N needs a contact angle above 0."
        raise ValueError(message)
    directions = np.stack([cosine * np.cos(angles), cosine * np.sin(angles), np.full(len(angles), sine)], axis=1)
    load = np.array([machine.load_x, machine.load_y, axial_load])
    factor, n = machine.load_deflection_factor, machine.contact_exponent
    # every ball carries the same part of the axial load
    equal_squeeze = (axial_load / (len(angles) * sine * factor)) ** (1 / n)
    start = np.array([0.0, 0.0, (max(machine.half_clearance, 0.0) + equal_squeeze) / sine])
    found = _equilibrium(directions, load, factor, n, machine.half_clearance, start)
    # rounded to a picometre: further digits depend on the linear algebra library of the processor
    return round(float(found[2] * sine), 12)


def _equilibrium(
    directions: FloatArray, load: FloatArray, factor: float, exponent: float, half_clearance: float, start: FloatArray
) -> FloatArray:
    """Displacement of the inner ring at which the forces of the balls along ``directions`` balance ``load``, shape (3,) [m].

    Newton steps down the potential energy, which is convex; a step that does not lower it is halved.
    """

    def energy(squeeze: FloatArray, q: FloatArray) -> float:
        return float(factor / (exponent + 1) * np.sum(squeeze ** (exponent + 1)) - load @ q)

    q, squeeze = start, np.maximum(directions @ start - half_clearance, 0.0)
    for _ in range(_MOST_STEPS):
        residual = load - (factor * squeeze**exponent) @ directions
        if np.abs(residual).max() < _BALANCED * np.abs(load).max():
            break
        stiffness = exponent * factor * squeeze ** (exponent - 1)
        step = np.linalg.solve((directions.T * stiffness) @ directions, residual)
        before, share = energy(squeeze, q), 1.0
        while True:
            moved = q + share * step
            squeezed = np.maximum(directions @ moved - half_clearance, 0.0)
            if energy(squeezed, moved) < before or share < _SMALLEST_SHARE:
                break
            share /= 2
        q, squeeze = moved, squeezed
    return q
