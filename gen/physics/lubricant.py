"""Temperature and oil film of a rolling element: clearance, viscosity, film thickness, stiffness and damping.

A warm inner ring expands and reduces the clearance [1]_. Warm oil has a lower viscosity [2]_ and density [3]_. Rolling carries oil
into both contacts of an element; elastohydrodynamic theory gives the film thickness for balls [4]_ and for rollers [5]_. The stiffness
of the film is the change of load over the change of thickness. Its damping is the force, over the closing speed, that squeezes oil out
of the gap, after Reynolds [6]_. The model assumes flooded isothermal contacts, smooth surfaces, and oil at the temperature of the
bearing.

.. [1] NTN Corporation, *Ball and Roller Bearings*, catalogue, eq. (8.3); IKO, *Needle Roller Bearings*, eq. (29), is the same.
.. [2] ASTM D341, Standard practice for viscosity-temperature charts for liquid petroleum products: Walther's equation.
.. [3] ASTM D1250, Standard guide for petroleum measurement tables (API MPMS ch. 11.1): expansion of lubricating oils.
.. [4] B. J. Hamrock, D. Dowson, "Isothermal elastohydrodynamic lubrication of point contacts, part III - fully flooded results",
   J. Lubr. Technol. 99 (1977) 264-276.
.. [5] D. Dowson, "Elastohydrodynamics", Proc. Inst. Mech. Eng. 182 (1967-68), part 3A, 151-167.
.. [6] R. G. Cox, H. Brenner, "The slow motion of a sphere through a viscous fluid towards a plane surface - II. Small gap
   widths, including inertial effects", Chem. Eng. Sci. 22 (1967) 1753-1777: its limit for a narrow gap, here for two curvatures.
"""

import math
from typing import NamedTuple

from gen.physics.bearing import Bearing, orders
from gen.physics.hertz import effective_modulus, ellipticity, known_roller_length, race_curvatures

ZERO_CELSIUS = 273.15  # [K]
STEEL_EXPANSION = 12.5e-6  # linear, bearing steel [1/K]
OIL_EXPANSION = 0.6278  # fall of the density of a lubricating oil, the same at every density [kg m^-3 K^-1]
POINT_LOAD_EXPONENT = 0.067
LINE_LOAD_EXPONENT = 0.13


class Lubricant(NamedTuple):
    """An oil; by default a mineral one of ISO VG 68."""

    viscosity_40: float = 68e-6
    """Kinematic viscosity at 40 C [m2/s]."""
    viscosity_100: float = 8.7e-6
    """Kinematic viscosity at 100 C [m2/s]."""
    density_15: float = 880.0
    """Density at 15 C [kg/m3]."""
    pressure_viscosity: float = 2e-8
    """Pressure-viscosity coefficient [1/Pa], the same at every temperature."""


class Film(NamedTuple):
    """Films of one rolling element on the inner and on the outer race, in series."""

    thickness: float
    """Sum of both thicknesses [m]."""
    stiffness: float
    """Force per change of ``thickness`` [N/m]."""
    damping: float
    """Force per rate of change of ``thickness`` [N s/m]."""


def kinematic_viscosity(lubricant: Lubricant, celsius: float) -> float:
    """Kinematic viscosity at a temperature in C [m2/s]: ``log log (nu + 0.7)`` is a falling linear function of ``log T``.

    The standard uses the constant 0.7 mm2/s for oils above 2 mm2/s.

    >>> round(1e6 * kinematic_viscosity(Lubricant(), 70), 2)
    20.12
    """
    at_40, at_100 = (math.log10(math.log10(1e6 * nu + 0.7)) for nu in (lubricant.viscosity_40, lubricant.viscosity_100))
    start, now, end = (math.log10(ZERO_CELSIUS + t) for t in (40, celsius, 100))
    height = at_40 + (at_100 - at_40) * (now - start) / (end - start)
    return 1e-6 * (10 ** (10**height) - 0.7)


def density(lubricant: Lubricant, celsius: float) -> float:
    """Density at a temperature in C [kg/m3], with the expansion of the petroleum tables to first order."""
    return lubricant.density_15 - OIL_EXPANSION * (celsius - 15)


def dynamic_viscosity(lubricant: Lubricant, celsius: float) -> float:
    """Dynamic viscosity at a temperature in C and atmospheric pressure [Pa s]."""
    return density(lubricant, celsius) * kinematic_viscosity(lubricant, celsius)


def warm_clearance(bearing: Bearing, diametral_clearance: float, inner_ring_hotter: float) -> float:
    """Diametral clearance if inner ring and balls are hotter than the outer ring by ``inner_ring_hotter`` [K]; negative for preload [m]."""
    return diametral_clearance - STEEL_EXPANSION * inner_ring_hotter * 2 * bearing.outer_radius


def entrainment_speed(bearing: Bearing, shaft_rate: float) -> float:
    """Speed at which rolling surfaces carry oil into a contact, the same for both races [m/s].

    In the frame of the cage both races and the ball surface pass a contact at ``pi * shaft_rate * pitch_diameter * (1 - gamma**2) / 2``,
    which is the circumference of the ball times its rate of spin.
    """
    return math.pi * bearing.ball_diameter * shaft_rate * orders(bearing).bsf


def point_film_thickness(
    curvatures: tuple[float, float],
    modulus: float,
    pressure_viscosity: float,
    viscous_speed: float,
    load: float,
) -> float:
    """Central film thickness between a ball and a race, after Hamrock and Dowson [m].

    Parameters
    ----------
    curvatures : tuple of float
        Sum of the curvatures of both bodies along and across the rolling direction [1/m].
    modulus : float
        Effective modulus [Pa].
    pressure_viscosity : float
        Pressure-viscosity coefficient of the oil [1/Pa].
    viscous_speed : float
        Dynamic viscosity times entrainment speed [N/m].
    load : float
        Force between ball and race [N].
    """
    radius = 1 / curvatures[0]
    U, G, W = viscous_speed / (modulus * radius), pressure_viscosity * modulus, load / (modulus * radius**2)
    side_leakage = 1 - 0.61 * math.exp(-0.73 * ellipticity(*curvatures))
    return 2.69 * U**0.67 * G**0.53 * W**-POINT_LOAD_EXPONENT * side_leakage * radius


def line_film_thickness(
    curvature: float, modulus: float, pressure_viscosity: float, viscous_speed: float, load_per_length: float
) -> float:
    """Smallest film thickness between a roller and a race, after Dowson [m].

    The arguments are those of :func:`point_film_thickness`, with the curvature along the rolling direction and the load in N/m.
    """
    radius = 1 / curvature
    U, G, W = viscous_speed / (modulus * radius), pressure_viscosity * modulus, load_per_length / (modulus * radius)
    return 2.65 * U**0.7 * G**0.54 * W**-LINE_LOAD_EXPONENT * radius


def point_squeeze_damping(curvatures: tuple[float, float], viscosity: float, thickness: float) -> float:
    """Damping by oil that is squeezed out of the gap between two rigid bodies [N s/m].

    In a gap ``h = thickness + (along * x**2 + across * y**2) / 2`` that closes at the speed ``v`` the pressure
    ``6 * viscosity * v / ((along + across) * h**2)`` solves the equation of Reynolds. For a ball of radius ``R`` on a plane the integral
    of the pressure over ``v`` is ``6 * pi * viscosity * R**2 / thickness``, the result of Cox and Brenner.
    """
    along, across = curvatures
    return 12 * math.pi * viscosity / ((along + across) * math.sqrt(along * across) * thickness)


def line_squeeze_damping(curvature: float, length: float, viscosity: float, thickness: float) -> float:
    """Damping by oil that is squeezed out under a roller [N s/m]: the pressure of a ball with ``across = 0``, over ``length``."""
    return 3 * math.sqrt(2) * math.pi * viscosity * length * (curvature * thickness) ** -1.5


def film(bearing: Bearing, lubricant: Lubricant, celsius: float, shaft_rate: float, ball_load: float) -> Film:
    """Oil film of one ball or roller, with its two contacts in series.

    The stiffness follows from the film thickness, which is proportional to a negative power of the load. The damping is that of rigid
    surfaces and of oil with its viscosity at the inlet. It is an order of magnitude only: a loaded contact is flat, and the pressure in it
    raises the viscosity of the oil.

    Parameters
    ----------
    bearing : Bearing
        A bearing with a fixed outer ring.
    lubricant : Lubricant
        The oil, in flooded contacts.
    celsius : float
        Temperature of bearing and oil [C].
    shaft_rate : float
        Rate of the shaft [Hz].
    ball_load : float
        Force between the rolling element and each race [N].

    Raises
    ------
    ValueError
        If the shaft does not rotate, the element has no load, or it is a roller of unknown length.
    """
    if shaft_rate <= 0 or ball_load <= 0:
        message = f"no film forms at shaft_rate = {shaft_rate} Hz and ball_load = {ball_load} N; both must be above 0."
        raise ValueError(message)
    modulus = effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio)
    viscosity = dynamic_viscosity(lubricant, celsius)
    oil = modulus, lubricant.pressure_viscosity, viscosity * entrainment_speed(bearing, shaft_rate)
    races = race_curvatures(bearing)
    if bearing.rolling_element == "ball":
        exponent = POINT_LOAD_EXPONENT
        films = [point_film_thickness(race, *oil, ball_load) for race in races]
        dampings = [point_squeeze_damping(race, viscosity, h) for race, h in zip(races, films, strict=True)]
    else:
        exponent, length = LINE_LOAD_EXPONENT, known_roller_length(bearing)
        films = [line_film_thickness(along, *oil, ball_load / length) for along, _ in races]
        dampings = [
            line_squeeze_damping(along, length, viscosity, h) for (along, _), h in zip(races, films, strict=True)
        ]
    thickness = sum(films)
    return Film(thickness, ball_load / (exponent * thickness), 1 / sum(1 / damping for damping in dampings))


def lubricated_factor(factor: float, exponent: float, ball_load: float, stiffness: float) -> float:
    """Load-deflection factor with the tangent, at ``ball_load``, of ``factor`` and of a film of ``stiffness`` in series.

    ``factor`` and the result are in N m^-n with ``n = exponent``, ``ball_load`` in N, ``stiffness`` in N/m.
    """
    tangent = exponent * factor ** (1 / exponent) * ball_load ** (1 - 1 / exponent)
    return factor * (1 + tangent / stiffness) ** -exponent
