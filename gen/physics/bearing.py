"""Geometry of a rolling bearing and its fault frequencies.

With the outer ring fixed and pure rolling, the cage turns at ``(1 - gamma) / 2`` of the shaft rate, where
``gamma = ball_diameter * cos(contact_angle) / pitch_diameter``. The other fault frequencies are the rates at which balls pass a point of
a race, and the rate at which a ball spins [1]_.

The balls of a ball bearing with clearance touch both races at the free contact angle when the rings are pushed apart along the axis [2]_.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics - A tutorial", Mech. Syst. Signal Process. 25 (2011) 485-520.
.. [2] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 2, free contact angle.
"""

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple


class FaultOrders(NamedTuple):
    """Fault frequencies in orders of the shaft; a ball spall strikes both races each spin, so its line is ``2 * bsf``."""

    ftf: float
    bpfo: float
    bpfi: float
    bsf: float


@dataclass(frozen=True)
class Bearing:
    """Geometry, material and catalogue data of a single-row rolling bearing, in SI units; an unknown value is ``None``.

    ``inner_conformity`` and ``outer_conformity`` are groove radius over ball diameter. In a roller bearing ``n_balls`` is the number of
    rollers, ``ball_diameter`` their diameter, and ``roller_length`` the length of their contact with the raceways.
    """

    designation: str
    n_balls: int
    pitch_diameter: float
    ball_diameter: float
    contact_angle: float = 0.0
    inner_conformity: float = 0.52
    outer_conformity: float = 0.52
    youngs_modulus: float = 207e9
    poisson_ratio: float = 0.30
    rolling_element: Literal["ball", "roller"] = "ball"
    roller_length: float | None = None
    dynamic_rating: float | None = None
    """Basic dynamic load rating, ISO 281 [N]."""
    static_rating: float | None = None
    """Basic static load rating, ISO 76 [N]."""
    bore: float | None = None
    outside_diameter: float | None = None
    width: float | None = None
    source: str = ""
    """Publication of the numbers."""
    printed_orders: FaultOrders | None = None
    """Fault orders that the maker prints, of a bearing whose diameters are not known (NaN)."""

    @property
    def gamma(self) -> float:
        """Ball diameter times the cosine of the contact angle, over pitch diameter [1]."""
        return self.ball_diameter * math.cos(self.contact_angle) / self.pitch_diameter

    @property
    def inner_radius(self) -> float:
        """Radius of the inner raceway at the groove bottom [m]."""
        return (self.pitch_diameter - self.ball_diameter * math.cos(self.contact_angle)) / 2

    @property
    def outer_radius(self) -> float:
        """Radius of the outer raceway at the groove bottom [m]."""
        return (self.pitch_diameter + self.ball_diameter * math.cos(self.contact_angle)) / 2

    def radius(self, site: str) -> float:
        """Radius of the damaged surface: that of the ``inner`` or ``outer`` raceway, or that of the ``ball`` [m]."""
        return {"inner": self.inner_radius, "outer": self.outer_radius, "ball": self.ball_diameter / 2}[site]


def orders(bearing: Bearing) -> FaultOrders:
    """Fault frequencies of pure rolling, or those that the maker prints [orders of the shaft].

    >>> [round(order, 4) for order in orders(Bearing("6205", 9, 39.04e-3, 7.94e-3))]
    [0.3983, 3.5848, 5.4152, 2.3567]
    """
    if bearing.printed_orders is not None:
        return bearing.printed_orders
    gamma = bearing.gamma
    ftf = (1 - gamma) / 2
    spin = bearing.pitch_diameter / (2 * bearing.ball_diameter) * (1 - gamma**2)
    return FaultOrders(ftf, bearing.n_balls * ftf, bearing.n_balls * (1 - ftf), spin)


def slipping_orders(bearing: Bearing, slip: float) -> FaultOrders:
    """Fault frequencies of a cage that is slower than in pure rolling by the fraction ``slip`` [orders of the shaft]."""
    rolling = orders(bearing)
    ftf = rolling.ftf * (1 - slip)
    return FaultOrders(ftf, bearing.n_balls * ftf, bearing.n_balls * (1 - ftf), rolling.bsf)


def free_contact_angle(bearing: Bearing, diametral_clearance: float) -> float:
    """Contact angle of a ball bearing whose rings are pushed apart along the axis without force [rad].

    ``cos(angle) = 1 - clearance / (2 A)``, where ``A = (inner + outer conformity - 1) * ball diameter`` is the distance between the centres
    of curvature of the two grooves. 0 for a bearing without clearance and for rollers.

    >>> round(math.degrees(free_contact_angle(Bearing("6205", 9, 39.04e-3, 7.94e-3), 10e-6)), 1)
    10.2
    """
    if diametral_clearance <= 0 or bearing.rolling_element == "roller":
        return 0.0
    apart = (bearing.inner_conformity + bearing.outer_conformity - 1) * bearing.ball_diameter
    return math.acos(max(1 - diametral_clearance / (2 * apart), 0.0))


def ball_spacing(bearing: Bearing, site: Literal["inner", "outer"]) -> float:
    """Arc on a race from one ball to the next [m].

    >>> round(1e3 * ball_spacing(Bearing("6205", 9, 39.04e-3, 7.94e-3), "outer"), 1)
    16.4
    """
    return 2 * math.pi * bearing.radius(site) / bearing.n_balls
