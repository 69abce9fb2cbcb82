"""Path of a ball over a measured or rough surface, and its mean over the width of the contact.

A rigid ball touches the surface at one point. Over a surface of depth ``z`` the drop of the ball centre is the minimum, over all
points, of ``z`` plus the sagittas of ball and race at the distance of the point. For two sharp edges and a flat floor this is the
``geometric`` profile of :mod:`gen.physics.kernel.drop`. A contact with the width of the Hertzian ellipse takes the mean of this path,
weighted with the contact pressure: the contact filter of Remington for wheel and rail [1]_. The mean smooths spalls that are narrower
than the contact.

.. [1] P. J. Remington, "Wheel/rail noise - part I: characterization of the wheel/rail dynamic system", J. Sound Vib. 46 (1976) 359-379.
"""

import numpy as np
from numpy.typing import NDArray

from gen.physics.extent import TABLE_POINTS

FloatArray = NDArray[np.float64]


def spall_positions(width: float) -> FloatArray:
    """Evenly spaced positions from edge to edge of a spall, 0 in the middle, shape (point,) [m]."""
    return np.linspace(-width / 2, width / 2, TABLE_POINTS)


def ball_path(depths: FloatArray, width: float, ball: float, race: float) -> FloatArray:
    """Drop of a ball that rolls over a surface, shape (point,) [m].

    Parameters
    ----------
    depths : array, shape (point,)
        Depth of the surface from edge to edge, evenly spaced; the depth of the two edges is replaced by 0 [m].
    width : float
        Width of the spall [m].
    ball, race : float
        Radius of the ball and of the race; a convex race (inner) has a positive radius, a concave one (outer) a negative radius [m].
    """
    along = np.linspace(0, 1, len(depths))
    surface = np.interp(np.linspace(0, 1, TABLE_POINTS), along, depths)
    surface[[0, -1]] = 0.0
    chord = spall_positions(width) - spall_positions(width)[:, None]
    inside = np.abs(chord) < ball
    chord = np.where(inside, chord, 0.0)
    sagittas = (ball - np.sqrt(ball**2 - chord**2)) + race - np.copysign(np.sqrt(race**2 - chord**2), race)
    return np.where(inside, surface + sagittas, np.inf).min(axis=1)


def rough_surface(rms: float, rng: np.random.Generator) -> FloatArray:
    """Height of a surface at wavelengths from a hundredth to a tenth of its length, shape (point,) [m]."""
    waves = np.zeros(TABLE_POINTS // 2 + 1, complex)
    waves[10:101] = np.exp(2j * np.pi * rng.random(91)) / np.arange(10, 101)
    height = np.fft.irfft(waves, TABLE_POINTS)
    return height * (rms / height.std())


def contact_mean(path: FloatArray, width: float, footprint: float, margin: float) -> FloatArray:
    """Mean of a path over a contact of half width ``footprint``, from ``margin`` before the first edge to ``margin`` after the last one.

    Parameters
    ----------
    path : array, shape (point,)
        Drop from edge to edge; the drop beyond the edges is 0 [m].
    width : float
        Width of the spall [m].
    footprint : float
        Half the width of the contact along the rolling direction [m].
    margin : float
        Distance of the first and the last point from the edges, at least ``footprint`` [m].

    Returns
    -------
    array, shape (point,)
        Mean of the path over the contact, weighted with the contact pressure [m].
    """
    edge = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 42))
    middle = (edge[1:] + edge[:-1]) / 2
    weight = np.diff(edge) * np.sqrt(1 - middle**2)
    under = spall_positions(width + 2 * margin)[:, None] + footprint * middle
    return np.interp(under, spall_positions(width), path, left=0.0, right=0.0) @ (weight / weight.sum())
