"""How far an axial load presses the balls up their grooves.

Shaft and balls move by ``axial`` along the axis, which squeezes every ball by ``axial * sin(contact_angle)`` more; in equilibrium the
axial parts of all ball forces carry the load. The contact angle is that of the drawing, and stays; the radial load rests on the
balls alone. A radial load pushes the rings of such a bearing apart: below about ``1.25 * radial load * tan(contact_angle)`` fewer
than half of the balls carry, and the pair comes loose. T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 7,
combined radial and thrust load.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from gen.physics.rotor import Machine

FloatArray = NDArray[np.float64]
# axial over radial load times the tangent of the contact angle, at which half of the balls are loaded
HALF_LOADED = 1.25
_MICROMETRE = 1e-6


def axial_approach(machine: Machine, axial_load: float, angles: FloatArray, heaviest: float = 1.0) -> float:
    """Squeeze that an axial load adds to every ball [m].

    Parameters
    ----------
    machine : Machine
        Gives radial load, clearance, contact angle and load-deflection law.
    axial_load : float
        Above 0 [N].
    angles : array, shape (ball,)
        Where the balls are [rad].
    heaviest : float
        Largest share of the radial load, which the axial load must hold against [1].

    Raises
    ------
    ValueError
        If the contact angle is 0, or the axial load too small to hold the rings together.
    """
    cosine = machine.contact_cosine
    sine = np.sqrt(1 - cosine**2)
    least = HALF_LOADED * heaviest * np.hypot(machine.load_x, machine.load_y) * sine / cosine
    if sine == 0 or axial_load < least:
        message = (
            f"an axial load of {axial_load:.4g} N is too small to hold its rings together; at least {least:.4g} N do."
        )
        if sine == 0:
            message = f"an axial load of {axial_load:g} N needs a contact angle above 0."
        raise ValueError(message)
    directions = np.stack([cosine * np.cos(angles), cosine * np.sin(angles), np.full(len(angles), sine)], axis=1)
    load = np.array([machine.load_x, machine.load_y, axial_load])
    factor, n = machine.load_deflection_factor, machine.contact_exponent

    def squeeze(q: FloatArray) -> FloatArray:
        return np.maximum(directions @ q * _MICROMETRE - machine.half_clearance, 0.0)

    def energy(q: FloatArray) -> float:
        return float(np.sum(factor / (n + 1) * squeeze(q) ** (n + 1)) / _MICROMETRE - load @ q)

    def slope(q: FloatArray) -> FloatArray:
        return (factor * squeeze(q) ** n) @ directions - load

    def curvature(q: FloatArray) -> FloatArray:
        stiffness = n * factor * _MICROMETRE * squeeze(q) ** (n - 1)
        return (directions.T * stiffness) @ directions

    alone = (axial_load / (len(angles) * sine * factor)) ** (1 / n)  # if all balls share it alike
    start = np.array([0.0, 0.0, (max(machine.half_clearance, 0.0) + alone) / sine / _MICROMETRE])
    found = minimize(
        energy, start, jac=slope, hess=curvature, method="trust-exact", options={"gtol": 1e-6 * axial_load}
    )
    # to the picometre: beyond it the digits are those of the processor's linear algebra
    return round(float(found.x[2] * _MICROMETRE * sine), 12)
