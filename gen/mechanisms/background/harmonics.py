"""Lines at multiples of the shaft rate."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Drawn, Draws, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.physics.orbit import along

_FLATTEST = 0.8  # orbit at a harmonic: the shaft never moves along a straight line


class Harmonics(BackgroundSource):
    """Lines at multiples of the shaft rate."""

    place = "harmonics"

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, at 1x, 2x, ... shaft rate; rounded to a whole number."""
    level_db: Distribution = within(-80, 40)
    """Rms of a line relative to that of the background noise, drawn for each; the mean over all directions and channels."""
    growth: Distribution = within(0, 4, default=0.0)
    """Power of the speed with which the lines grow along `operation.speed_profile`; 2 is that of an unbalance."""

    def draw_present(self, draws: Draws) -> tuple[Drawn, ...]:
        """Order and level of each line; the growth is drawn later."""
        orders = range(1, round(draws.value(self.count)) + 1)
        return tuple({"frequency": float(order), "level": draws.ratio(self.level_db)} for order in orders)


def motion_of_harmonics(
    drawn: Sequence[Drawn], directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, NDArray[np.complex128]]:
    """Amplitude of each harmonic, shape (order,), and its motion along some ``directions`` [rad], shape (direction, order) [1].

    The first is in phase with the unbalance, which points along the mark of the shaft.
    """
    levels = np.zeros(max((int(line["frequency"]) for line in drawn), default=0))
    for line in drawn:
        levels[int(line["frequency"]) - 1] = math.sqrt(2) * line["level"]
    forward, backward, flatness = rng.random((3, len(levels)))
    forward[:1] = 0.0
    return levels, along(directions, 2 * np.pi * forward, 2 * np.pi * backward, _FLATTEST * flatness)
