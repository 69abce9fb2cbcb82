"""The path of a ball over a measured or rough surface, and its mean over the width of the contact.

A rigid ball rests on the point that it touches first: over a surface at depth ``z`` its centre drops by the minimum over all points of
``z`` plus the sagittas of ball and race over the distance to the point. For two sharp edges and a floor this is the ``geometric`` profile
of :mod:`gen.physics.kernel.drop`. A contact has the width of its Hertzian ellipse, and averages the path over it, weighted by its
pressure: the contact filter of Remington for wheel and rail [1]_. It smooths spalls narrower than the contact.

.. [1] P. J. Remington, "Wheel/rail noise - part I: characterization of the wheel/rail dynamic system", J. Sound Vib. 46 (1976) 359-379.
"""

import numpy as np
from numpy.typing import NDArray

from gen.physics.extent import TABLE_POINTS

FloatArray = NDArray[np.float64]


def places(width: float) -> FloatArray:
    """Places from edge to edge of a spall, shape (point,) [m]."""
    return np.linspace(-width / 2, width / 2, TABLE_POINTS)


def ball_path(depths: FloatArray, width: float, ball: float, race: float) -> FloatArray:
    """Drop of a ball that rolls over a surface, shape (point,) [m].

    Parameters
    ----------
    depths : array, shape (point,)
        Depth of the surface from edge to edge, evenly spaced [m]; at the edges it is taken as 0.
    width : float
        From edge to edge [m].
    ball, race : float
        Radius of the ball, and of the race: positive if convex (inner), negative if concave (outer) [m].
    """
    along = np.linspace(0, 1, len(depths))
    surface = np.interp(np.linspace(0, 1, TABLE_POINTS), along, depths)
    surface[[0, -1]] = 0.0
    chord = places(width) - places(width)[:, None]
    inside = np.abs(chord) < ball
    chord = np.where(inside, chord, 0.0)
    sagittas = (ball - np.sqrt(ball**2 - chord**2)) + race - np.copysign(np.sqrt(race**2 - chord**2), race)
    return np.where(inside, surface + sagittas, np.inf).min(axis=1)


def with_roughness(depths: FloatArray, rms: float, rng: np.random.Generator) -> FloatArray:
    """Depth of a surface plus roughness of ``rms`` at wavelengths from a hundredth to a tenth of its width, shape (point,) [m]."""
    waves = np.zeros(len(depths) // 2 + 1, complex)
    waves[10:101] = np.exp(2j * np.pi * rng.random(91)) / np.arange(10, 101)
    roughness = np.fft.irfft(waves, len(depths))
    return np.maximum(depths + roughness * (rms / roughness.std()), 0.0)


def contact_mean(path: FloatArray, width: float, footprint: float, margin: float) -> FloatArray:
    """Mean of a path under a contact of half width ``footprint``, from ``margin`` before one edge to ``margin`` after the other.

    Parameters
    ----------
    path : array, shape (point,)
        Drop from edge to edge, 0 beyond [m].
    width : float
        From edge to edge [m].
    footprint : float
        Half the width of the contact along the rolling direction [m].
    margin : float
        At least ``footprint`` [m].

    Returns
    -------
    array, shape (point,)
        Mean of the path under the contact, weighted with its pressure [m].
    """
    edge = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 42))
    middle = (edge[1:] + edge[:-1]) / 2
    weight = np.diff(edge) * np.sqrt(1 - middle**2)
    under = places(width + 2 * margin)[:, None] + footprint * middle
    return np.interp(under, places(width), path, left=0.0, right=0.0) @ (weight / weight.sum())
