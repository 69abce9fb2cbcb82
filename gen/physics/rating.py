"""Static load rating of a bearing, and equivalent static load.

ISO 76 [1]_ defines a limit of the contact pressure, at which a permanent dent of about 1/10,000 of the element diameter remains. The load
of the most loaded element is ``5 F / (Z cos(contact_angle))`` after Stribeck. The static rating is the radial load ``F`` at which this
element reaches the limit on the inner or on the outer raceway [2]_.

.. [1] ISO 76:2006, Rolling bearings - Static load ratings.
.. [2] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 6 (contact pressure) and ch. 21 (static rating).
"""

import functools
import math

from gen.physics.bearing import Bearing
from gen.physics.hertz import effective_modulus, ellipse_volume, ellipticity, known_roller_length, race_curvatures
from gen.physics.rotor import STRIBECK

BALL_PRESSURE, ROLLER_PRESSURE = 4200e6, 4000e6  # [Pa], ISO 76, radial bearings that are not self-aligning

# Least static rating over equivalent static load. Makers require 0.5 or more even for bearings that hardly turn. Below 0.5 the pressure of
# a ball contact is above 5300 MPa (it grows with the cube root of the load): the contact yields, and the elastic model does not hold.
LEAST_SAFETY = 0.5


@functools.lru_cache(maxsize=4096)
def static_rating(bearing: Bearing) -> float:
    """Basic static load rating [N]: the rating of the catalogue if there is one, otherwise the rating computed from the geometry.

    Raises
    ------
    ValueError
        If the bearing has no rating in the catalogue and its rollers have no known length.
    """
    return computed_rating(bearing) if bearing.static_rating is None else bearing.static_rating


def computed_rating(bearing: Bearing) -> float:
    """Basic static load rating computed from the geometry [N].

    >>> round(computed_rating(Bearing("6205", 9, 39.04e-3, 7.94e-3)) / 1e3, 1)
    7.9

    Raises
    ------
    ValueError
        If the bearing has rollers of unknown length.
    """
    modulus = effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio)
    contacts = race_curvatures(bearing)
    if bearing.rolling_element == "roller":
        length = known_roller_length(bearing)
        heaviest = min(_line_load(along, modulus) * length for along, _ in contacts)
    else:
        heaviest = min(_point_load(along, across, modulus) for along, across in contacts)
    return heaviest * bearing.n_balls * math.cos(bearing.contact_angle) / STRIBECK


def equivalent_load(radial: float, axial: float, contact_angle: float) -> float:
    """Equivalent static load [N]: ``max(F, 0.5 F + 0.22 cot(contact_angle) A)`` of ISO 76, and ``F`` without an axial load.

    The standard uses the second term for angular contact bearings only. The model has a constant contact angle, so the term holds here for
    any angle: an axial load ``A`` adds the force ``A / (Z sin(contact_angle))`` to each ball, however small the angle is.

    >>> round(equivalent_load(1000.0, 2000.0, math.radians(40)))
    1024
    """
    if axial == 0 or contact_angle == 0:
        return radial
    return max(radial, 0.5 * radial + 0.22 * axial / math.tan(abs(contact_angle)))


def _point_load(along: float, across: float, modulus: float) -> float:
    """Load of a ball at which the centre of its elliptical contact reaches ``BALL_PRESSURE`` [N].

    The pressure is ``3 Q / (2 pi a b)`` with semi-axes ``b = (6 k^2 E Q / (pi E' sum of curvatures))^(1/3) / k`` and ``a = k b``.
    """
    ratio = ellipticity(along, across)
    volume = ellipse_volume(along, across, modulus)
    return (BALL_PRESSURE * math.pi * volume ** (2 / 3) / (1.5 * ratio)) ** 3


def _line_load(along: float, modulus: float) -> float:
    """Load per length of a roller at which its contact reaches ``ROLLER_PRESSURE`` [N/m], after Hertz: ``p^2 = q E' / (2 pi R)``."""
    return 2 * math.pi * ROLLER_PRESSURE**2 / (modulus * along)
