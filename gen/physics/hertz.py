"""Contact of a ball or a roller with its two raceways.

The force on a rolling element squeezed by ``deflection`` is ``factor * deflection**exponent``. For the point contact of a ball the
exponent is 3/2, and the factor follows from the curvatures through the elliptic integrals of the contact ellipse [1]_. For the line
contact of a steel roller the exponent is 10/9, and the factor is the empirical one of Palmgren, a function of the length alone [2]_.
The contacts on the inner and on the outer raceway act in series.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 6.
.. [2] A. Palmgren, *Ball and Roller Bearing Engineering*, 3rd ed., Burbank, 1959; in [1]_ the line contacts of ch. 6 and 7.
"""

import math

from gen.physics.bearing import Bearing

POINT_EXPONENT = 3 / 2
LINE_EXPONENT = 10 / 9


def effective_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """Effective modulus of two bodies of one material, E' = E / (1 - nu^2) [Pa]."""
    return youngs_modulus / (1 - poisson_ratio**2)


def ellipticity(rolling_curvature: float, transverse_curvature: float) -> float:
    """Long semi-axis of the contact ellipse over the short one [1], from the curvatures of ``contact_factor``."""
    from scipy.optimize import brentq  # SciPy loads for 0.2 s, and reading a recipe seldom needs it
    from scipy.special import ellipe, ellipk

    radius = 1 / (rolling_curvature + transverse_curvature)
    difference = radius * (rolling_curvature - transverse_curvature)

    def mismatch(ratio: float) -> float:
        m = 1 - ratio**-2
        return ((ratio**2 + 1) * ellipe(m) - 2 * ellipk(m)) / ((ratio**2 - 1) * ellipe(m)) - difference

    # near ratio 1 the quotient is 0/0 and loses its digits; the limit is a circular contact
    return brentq(mismatch, 1 + 1e-5, 1e4, xtol=1e-14, rtol=1e-14) if difference > 1e-4 else 1.0


def contact_factor(rolling_curvature: float, transverse_curvature: float, modulus: float) -> float:
    """Load-deflection factor of an elliptical contact [N m^-3/2].

    Parameters
    ----------
    rolling_curvature, transverse_curvature : float
        Sum of the curvatures of both bodies along and across the rolling direction; the first is the larger one [1/m].
    modulus : float
        Effective modulus [Pa].
    """
    from scipy.special import ellipe, ellipk

    radius = 1 / (rolling_curvature + transverse_curvature)
    ratio = ellipticity(rolling_curvature, transverse_curvature)
    m = 1 - ratio**-2
    return math.pi * ratio * modulus * math.sqrt(radius * ellipe(m) / (4.5 * ellipk(m) ** 3))


def line_contact_factor(length: float) -> float:
    """Load-deflection factor of one contact of a steel roller with a raceway, of contact length ``length`` [N m^-10/9].

    Palmgren gives the approach of roller and raceway in mm, ``3.84e-5 * force**0.9 / length**0.8`` with newtons and millimetres; the
    factor is that of the force as a function of the approach. Some authors use the formula for both contacts of a roller together;
    comparison with the elastic half-space shows that it holds for one contact.

    >>> round(line_contact_factor(0.010) / 1e9, 4)  # ten millimetres
    1.3444
    """
    return (1e3 / 3.84e-5) ** LINE_EXPONENT * (1e3 * length) ** (8 / 9)


def series_factor(inner: float, outer: float, exponent: float = POINT_EXPONENT) -> float:
    """Load-deflection factor of two contacts in series [N m^-n], ``n`` the ``exponent`` of both.

    >>> round(series_factor(1.0, 1.0), 4)
    0.3536
    """
    return (inner ** (-1 / exponent) + outer ** (-1 / exponent)) ** -exponent


def race_curvatures(bearing: Bearing) -> tuple[tuple[float, float], tuple[float, float]]:
    """Curvatures along and across the rolling direction of a ball on the inner and on the outer race [1/m]."""
    cosine = math.cos(bearing.contact_angle)
    ball = 2 / bearing.ball_diameter
    inner = ball + cosine / bearing.inner_radius, ball - 1 / (bearing.inner_conformity * bearing.ball_diameter)
    outer = ball - cosine / bearing.outer_radius, ball - 1 / (bearing.outer_conformity * bearing.ball_diameter)
    return inner, outer


def race_factors(bearing: Bearing) -> tuple[float, float]:
    """Load-deflection factors of the inner and the outer contact of a ball [N m^-3/2]."""
    modulus = effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio)
    inner, outer = race_curvatures(bearing)
    return contact_factor(*inner, modulus), contact_factor(*outer, modulus)


def contact_exponent(bearing: Bearing) -> float:
    """Exponent of the load-deflection law: 3/2 for balls, 10/9 for rollers."""
    return POINT_EXPONENT if bearing.rolling_element == "ball" else LINE_EXPONENT


def known_roller_length(bearing: Bearing) -> float:
    """Contact length of a roller [m]; raises ValueError if the bearing has none."""
    if bearing.roller_length is None:
        message = f"bearing {bearing.designation}: the length of its rollers is not known; give roller_length."
        raise ValueError(message)
    return bearing.roller_length


def load_deflection_factor(bearing: Bearing) -> float:
    """Load-deflection factor of a rolling element between its raceways [N m^-n], ``n`` the ``contact_exponent``.

    Raises
    ------
    ValueError
        If the bearing has rollers of unknown length.
    """
    if bearing.rolling_element == "ball":
        return series_factor(*race_factors(bearing))
    contact = line_contact_factor(known_roller_length(bearing))
    return series_factor(contact, contact, LINE_EXPONENT)


def footprints(bearing: Bearing, ball_load: float) -> tuple[float, float]:
    """Half the width of the inner and of the outer contact along the rolling direction under ``ball_load`` [m]."""
    modulus = effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio)
    if bearing.rolling_element == "roller":
        per_length = ball_load / known_roller_length(bearing)
        inner, outer = (
            math.sqrt(8 * per_length / (math.pi * modulus * along)) for along, _ in race_curvatures(bearing)
        )
        return inner, outer
    inner, outer = (_half_width(along, across, ball_load, modulus) for along, across in race_curvatures(bearing))
    return inner, outer


def _half_width(along: float, across: float, load: float, modulus: float) -> float:
    ratio = ellipticity(along, across)
    return (ellipse_volume(along, across, modulus) * load) ** (1 / 3) / ratio


def ellipse_volume(along: float, across: float, modulus: float) -> float:
    """Cube of the long semi-axis of the contact ellipse over the load [m3/N]: ``6 k^2 E(m) R / (pi E')`` with ``m = 1 - 1 / k^2``."""
    from scipy.special import ellipe

    ratio = ellipticity(along, across)
    return 6 * ratio**2 * float(ellipe(1 - ratio**-2)) / (math.pi * modulus * (along + across))
