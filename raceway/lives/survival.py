"""Survival of bearings of which some are censored or were first seen late: Kaplan and Meier, and Weibull.

A bearing is at risk from its ``entry`` to its ``end``, where it has ``failed`` or left the test.

The band of the Kaplan-Meier curve has Greenwood's variance on the scale of ``log(-log S)`` [1]_.

.. [1] J. D. Kalbfleisch, R. L. Prentice, *The Statistical Analysis of Failure Time Data*, 2nd ed., Wiley, 2002, ch. 1.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import ndtri

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


class Survival(NamedTuple):
    """Share of bearings that live at each of some rising times, shape (time,)."""

    time: FloatArray
    share: FloatArray
    spread: FloatArray
    """Standard deviation of ``log(-log share)``."""

    def at(self, time: FloatArray) -> FloatArray:
        """Share that lives at some times; 1 before the first failure."""
        place = np.searchsorted(self.time, time, side="right")
        return np.concatenate([[1.0], self.share])[place]

    def median_left(self, age: FloatArray) -> FloatArray:
        """Time in which half of the bearings of some ages fail; until the last known failure where fewer do."""
        half = self.at(age) / 2
        place = np.minimum(np.searchsorted(-self.share, -half), len(self.time) - 1)
        return np.maximum(self.time[place] - age, 0.0)

    def band(self) -> tuple[FloatArray, FloatArray]:
        """Ends of the band that holds the true share at each time with a probability of 95 %."""
        away = ndtri(0.975) * self.spread
        with np.errstate(divide="ignore"):
            low, high = (self.share ** np.exp(side * away) for side in (1, -1))
        return low, high


def kaplan_meier(entry: FloatArray, end: FloatArray, failed: BoolArray) -> Survival:
    """Survival of bearings, shape (bearing,) each."""
    time, deaths = np.unique(end[failed], return_counts=True)
    at_risk = ((entry[:, None] < time) & (end[:, None] >= time)).sum(axis=0)
    share = np.cumprod(1 - deaths / at_risk)
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = np.sqrt(np.cumsum(deaths / (at_risk * (at_risk - deaths)))) / np.abs(np.log(share))
    return Survival(time, share, spread)


def weibull(entry: FloatArray, end: FloatArray, failed: BoolArray) -> tuple[float, float]:
    """Slope and scale of the most likely Weibull distribution."""
    scale = end.mean()

    def unlikeliness(logarithms: FloatArray) -> float:
        slope, wide = np.exp(logarithms)
        risk = (end / scale / wide) ** slope - (entry / scale / wide) ** slope
        rate = np.log(slope / wide) + (slope - 1) * np.log(end[failed] / scale / wide)
        return float(risk.sum() - rate.sum())

    slope, wide = np.exp(minimize(unlikeliness, np.zeros(2), method="Nelder-Mead").x)
    return float(slope), float(wide * scale)


def weibull_median_left(slope: float, scale: float, age: FloatArray) -> FloatArray:
    """Time in which half of the bearings of some ages fail."""
    # by logarithms, since powers of a steep slope overflow
    with np.errstate(divide="ignore"):
        hazard = slope * np.log(age / scale)
    return np.maximum(scale * np.exp(np.logaddexp(hazard, np.log(np.log(2))) / slope) - age, 0.0)
