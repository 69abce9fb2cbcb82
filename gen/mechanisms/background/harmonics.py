"""Lines at multiples of the shaft rate."""

import math

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.physics.orbit import along
from gen.support.units import decibel_to_ratio

_FLATTEST = 0.8  # orbit at a harmonic: the shaft never moves along a straight line


class Harmonics(BackgroundSource):
    """Lines at multiples of the shaft rate."""

    place = "harmonics"

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, at 1x, 2x, ... shaft rate; rounded to a whole number."""
    level_db: Distribution = within(-80, 40, each=True)
    """Rms of a line relative to that of the background noise, drawn for each; the mean over all directions and channels."""
    growth: Distribution = within(0, 4, default=0.0)
    """Power of the speed with which the lines grow along `operation.speed_profile`; 2 is that of an unbalance."""


def motion_of_harmonics(
    drawn: Harmonics | None, directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, NDArray[np.complex128]]:
    """Amplitude of each harmonic, shape (order,), and its motion along some ``directions`` [rad], shape (direction, order) [1].

    The first is in phase with the unbalance, which points along the mark of the shaft.
    """
    levels = np.zeros(0) if drawn is None else math.sqrt(2) * decibel_to_ratio(drawn.si()["level"])
    forward, backward, flatness = rng.random((3, len(levels)))
    forward[:1] = 0.0
    return levels, along(directions, 2 * np.pi * forward, 2 * np.pi * backward, _FLATTEST * flatness)
