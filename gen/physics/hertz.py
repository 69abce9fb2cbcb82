"""Hertz point contact between a ball and its two raceways.

A ball squeezed by ``deflection`` pushes back with ``factor * deflection**1.5``. The factor of one contact follows from the curvatures
through the elliptic integrals of the contact ellipse [1]_; the contacts on the inner and on the outer raceway act in series.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 6.
"""

import math

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from gen.physics.bearing import Bearing


def effective_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """Effective modulus of two bodies of one material, E' = E / (1 - nu^2) [Pa]."""
    return youngs_modulus / (1 - poisson_ratio**2)


def contact_factor(rolling_curvature: float, transverse_curvature: float, modulus: float) -> float:
    """Load-deflection factor of an elliptical contact [N m^-3/2].

    Parameters
    ----------
    rolling_curvature, transverse_curvature : float
        Sum of the curvatures of both bodies along and across the rolling direction, the larger one first [1/m].
    modulus : float
        Effective modulus [Pa].
    """
    radius = 1 / (rolling_curvature + transverse_curvature)
    difference = radius * (rolling_curvature - transverse_curvature)

    def mismatch(ratio: float) -> float:
        m = 1 - ratio**-2
        return ((ratio**2 + 1) * ellipe(m) - 2 * ellipk(m)) / ((ratio**2 - 1) * ellipe(m)) - difference

    # a nearly round contact: the quotient loses its digits and its limit at ratio 1 is the sphere
    ratio = brentq(mismatch, 1 + 1e-5, 1e4, xtol=1e-14, rtol=1e-14) if difference > 1e-4 else 1.0
    m = 1 - ratio**-2
    return math.pi * ratio * modulus * math.sqrt(radius * ellipe(m) / (4.5 * ellipk(m) ** 3))


def series_factor(inner: float, outer: float) -> float:
    """Load-deflection factor of both contacts of one ball [N m^-3/2].

    >>> round(series_factor(1.0, 1.0), 4)
    0.3536
    """
    return (inner ** (-2 / 3) + outer ** (-2 / 3)) ** (-3 / 2)


def race_factors(bearing: Bearing) -> tuple[float, float]:
    """Load-deflection factors of the inner and the outer contact of a ball [N m^-3/2]."""
    cosine = math.cos(bearing.contact_angle)
    ball = 2 / bearing.ball_diameter
    modulus = effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio)
    inner = contact_factor(
        ball + cosine / bearing.inner_radius,
        ball - 1 / (bearing.inner_conformity * bearing.ball_diameter),
        modulus,
    )
    outer = contact_factor(
        ball - cosine / bearing.outer_radius,
        ball - 1 / (bearing.outer_conformity * bearing.ball_diameter),
        modulus,
    )
    return inner, outer


def load_deflection_factor(bearing: Bearing) -> float:
    """Load-deflection factor of a ball between its raceways [N m^-3/2]."""
    return series_factor(*race_factors(bearing))
