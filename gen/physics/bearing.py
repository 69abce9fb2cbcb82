"""Geometry of a rolling bearing and the fault frequencies that follow from it.

With the outer ring fixed and pure rolling, the cage turns at ``(1 - gamma) / 2`` of the shaft rate, where
``gamma = ball_diameter * cos(contact_angle) / pitch_diameter``; every other frequency follows from counting passages [1]_.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics - A tutorial", Mech. Syst. Signal Process. 25 (2011) 485-520.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True)
class Bearing:
    """Geometry and material of a ball bearing, in SI units.

    ``inner_conformity`` and ``outer_conformity`` are groove radius over ball diameter.
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
    roller_length: float | None = None

    @property
    def gamma(self) -> float:
        """Ball diameter over pitch diameter, seen along the contact [1]."""
        return self.ball_diameter * math.cos(self.contact_angle) / self.pitch_diameter

    @property
    def inner_radius(self) -> float:
        """Radius of the inner raceway at the groove bottom [m]."""
        return (self.pitch_diameter - self.ball_diameter * math.cos(self.contact_angle)) / 2

    @property
    def outer_radius(self) -> float:
        """Radius of the outer raceway at the groove bottom [m]."""
        return (self.pitch_diameter + self.ball_diameter * math.cos(self.contact_angle)) / 2


class Orders(NamedTuple):
    """Fault frequencies in orders of the shaft; a ball spall strikes both races each spin, so its line is ``2 * bsf``."""

    ftf: float
    bpfo: float
    bpfi: float
    bsf: float


def orders(bearing: Bearing) -> Orders:
    """Fault frequencies of pure rolling [orders of the shaft].

    >>> [round(order, 4) for order in orders(CATALOGUE["6205"])]
    [0.3983, 3.5848, 5.4152, 2.3567]
    """
    gamma = bearing.gamma
    ftf = (1 - gamma) / 2
    spin = bearing.pitch_diameter / (2 * bearing.ball_diameter) * (1 - gamma**2)
    return Orders(ftf, bearing.n_balls * ftf, bearing.n_balls * (1 - ftf), spin)


def slipping_orders(bearing: Bearing, slip: float) -> Orders:
    """Fault frequencies when the cage lags by the fraction ``slip`` of its rolling speed [orders of the shaft]."""
    rolling = orders(bearing)
    ftf = rolling.ftf * (1 - slip)
    return Orders(ftf, bearing.n_balls * ftf, bearing.n_balls * (1 - ftf), rolling.bsf)


def _millimetres(designation: str, n_balls: int, pitch: float, ball: float) -> Bearing:
    return Bearing(designation, n_balls, pitch * 1e-3, ball * 1e-3)


# 6205: bearing data of the CWRU Bearing Data Center (1.537 in, 0.3126 in). NICE: Bechhoefer, MFPT fault data sets
# (1.245 in, 0.235 in). 6205-paper: the rounded geometry of Ophel et al. The others: makers' pitch and ball sizes.
CATALOGUE = {
    bearing.designation: bearing
    for bearing in (
        _millimetres("6205", 9, 39.04, 7.94),
        _millimetres("6205-paper", 9, 39.0, 8.0),
        _millimetres("NICE", 8, 31.623, 5.969),
        _millimetres("6203", 8, 28.5, 6.747),
    )
}
