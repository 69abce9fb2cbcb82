"""Where the mass of a rolling element strikes the edges of a spall, and how long such an impact lasts.

The path of a rigid ball over a spall bends sharply where the ball changes from one edge to the other, or where it meets or leaves the
floor. There the ball is thrown back. The impact of an elastic ball of mass ``m`` and radius ``R`` on a flat body of the same material, at
the speed ``V``, lasts ``2.87 (m^2 / (R E*^2 V))^(1/5)`` [1]_. The radius of the edge itself is not known, so it is left out; the length
changes with the fifth root of it.

.. [1] K. L. Johnson, *Contact Mechanics*, Cambridge University Press, 1985, sec. 11.4.
"""

import math

import numpy as np
from numpy.typing import NDArray

from gen.physics.bearing import Bearing
from gen.physics.elementary import power
from gen.physics.extent import MOST_STRIKES
from gen.physics.hertz import effective_modulus
from gen.physics.inputs import Strike
from gen.physics.kernel.drop import FAR_INSIDE, sagitta

FloatArray = NDArray[np.float64]

STEEL = 7800.0  # density of bearing steel [kg m-3]
BISECTIONS = 60
LEAST_SHARE = 0.05  # of the largest strike over a table; smaller ones are left out


def rolling_mass(bearing: Bearing) -> float:
    """Mass of one steel ball or roller [kg].

    >>> round(1e3 * rolling_mass(Bearing("6205", 9, 39.04e-3, 7.94e-3)), 3)  # grams
    2.044
    """
    if bearing.roller_length is None:
        return STEEL * math.pi / 6 * bearing.ball_diameter**3
    return STEEL * math.pi / 4 * bearing.ball_diameter**2 * bearing.roller_length


def hertz_time(bearing: Bearing) -> float:
    """Length of the impact of a ball on a flat of the same steel, times the fifth root of its speed [s (m/s)^(1/5)].

    >>> bearing = Bearing("6205", 9, 39.04e-3, 7.94e-3)
    >>> round(1e6 * hertz_time(bearing) * 0.09**-0.2, 1)  # microseconds at 0.09 m/s
    44.6
    """
    modulus = effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio) / 2  # E* of two bodies of one material
    square = rolling_mass(bearing) ** 2 / (bearing.ball_diameter / 2 * modulus**2)
    return 2.87 * float(power(square, 0.2))


def edge_strikes(width: float, arc: float, ball: float, race: float, depth: float) -> tuple[Strike, ...]:
    """Strikes over a geometric spall: one in the middle if the ball bridges it, or one at either end of the floor.

    Parameters are those of :func:`gen.physics.kernel.drop.drop`, with the whole ``width`` [m].
    """
    half = 0.5 * width / arc
    inside = min(half, FAR_INSIDE)

    def dropped(angle: float) -> float:
        chord = min(arc * math.sin(angle), ball)
        return float(sagitta(chord, ball) + sagitta(chord, race))

    if dropped(inside) <= depth:
        return (Strike(0.0, 2 * _slope(inside, arc, ball, race)),)
    low, high = 0.0, inside
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if dropped(middle) <= depth else (low, middle)
    change = _slope(high, arc, ball, race)
    return Strike(high - half, change), Strike(half - high, change)


def _slope(angle: float, arc: float, ball: float, race: float) -> float:
    """Slope of the path of a ball whose contact is ``angle`` inside an edge [1]."""
    chord = min(arc * math.sin(angle), 0.99 * ball)  # beyond, the edge is as high as the ball: no spall is as deep
    return math.cos(angle) * (
        chord / math.sqrt(ball**2 - chord**2) + math.copysign(chord, race) / math.sqrt(race**2 - chord**2)
    )


def path_strikes(path: FloatArray, width: float, arc: float) -> tuple[Strike, ...]:
    """The largest strikes over a tabulated path: each run of points at which the path bends away from the race is one strike.

    Parameters
    ----------
    path : array, shape (point,)
        Drop of the ball from edge to edge, evenly spaced [m].
    width : float
        Distance of the first from the last point [m].
    arc : float
        Radius on which the width is measured [m].
    """
    spacing = width / (len(path) - 1)
    bends = np.maximum(-np.diff(path, 2), 0.0) / spacing
    edges = np.flatnonzero(np.diff(np.concatenate([[0], bends > 0, [0]])))
    strikes = []
    for first, end in edges.reshape(-1, 2):
        run = bends[first:end]
        centre = float((np.arange(first, end) + 1) @ run / run.sum())
        offset = (centre / (len(path) - 1) - 0.5) * width / arc
        strikes.append(Strike(offset, float(run.sum()), (end - first - 1) * spacing / arc))
    strikes.sort(key=lambda strike: -strike.change)
    return tuple(strike for strike in strikes[:MOST_STRIKES] if strike.change >= LEAST_SHARE * strikes[0].change)
