"""Life of one bearing under slow histories of load and speed.

Load, speed and the noise of the growth are Ornstein-Uhlenbeck processes [1]_, exact at every step and stationary from the start. Load and
noise are log-normal, with the mean 1. Fatigue adds up linearly after Palmgren and Miner: the spall begins when the turns, each over the
rating life at its load, reach the drawn share of the rating life. Behind the last step everything goes on at its mean rate.

.. [1] D. T. Gillespie, "Exact numerical simulation of the Ornstein-Uhlenbeck process and its integral", Phys. Rev. E 54 (1996) 2084-2091.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gen.life.fatigue import Element, rating_life
from gen.life.growth import Growth, drive_between, length_after

FloatArray = NDArray[np.float64]
STEPS = 8
"""Steps of a history in its correlation time."""


def history(rng: np.random.Generator, count: int) -> FloatArray:
    """Ornstein-Uhlenbeck process of unit variance, with ``STEPS`` steps in its correlation time, shape (step,) [1]."""
    from scipy.signal import lfilter  # SciPy loads for 0.2 s, and recipes without a life do not need it

    kept = math.exp(-1 / STEPS)
    shocks = rng.standard_normal(count) * math.sqrt(1 - kept**2)
    shocks[0] /= math.sqrt(1 - kept**2)
    return np.asarray(lfilter([1.0], [1.0, -kept], shocks))


def log_normal(process: FloatArray, spread: float) -> FloatArray:
    """Factors of mean 1 whose logarithms have the standard deviation ``spread`` [1]."""
    return np.exp(spread * process - spread**2 / 2)


@dataclass(frozen=True)
class Ageing:
    """Sums over the age of a bearing, at even steps, shape (step,)."""

    age: FloatArray
    """[s]."""
    turns: FloatArray
    """Of the shaft [1]."""
    fatigue: FloatArray
    """Turns over the rating life [1]."""
    drive: FloatArray
    """Of the growth of a spall [turns at the dynamic rating]."""

    def at(self, name: str, age: ArrayLike) -> FloatArray:
        """Sum ``name`` at some ages."""
        return _extended(age, self.age, getattr(self, name))

    def age_at(self, name: str, value: float) -> float:
        """Age at which the sum ``name`` reaches a value [s]."""
        return float(_extended(value, getattr(self, name), self.age))


def ageing(
    step: float,
    rate: NDArray[np.floating],
    load_ratio: NDArray[np.floating],
    noise: NDArray[np.floating],
    *,
    element: Element,
    factor: float = 1.0,
    load_exponent: float = 3.0,
) -> Ageing:
    """Sums of a history.

    Parameters
    ----------
    step : float
        From one value to the next [s].
    rate, load_ratio, noise : array, shape (step,)
        Shaft rate [Hz], equivalent load over the dynamic rating [1], and factor of the growth [1].
    element, factor :
        As for :func:`gen.life.fatigue.rating_life`.
    load_exponent : float
        ``q`` of the growth [1].
    """
    fatigue = rate / [rating_life(ratio, element, factor) for ratio in load_ratio]
    turns, fatigue, drive = (_sum(step, each) for each in (rate, fatigue, rate * load_ratio**load_exponent * noise))
    return Ageing(step * np.arange(len(rate), dtype=np.float64), turns, fatigue, drive)


@dataclass(frozen=True)
class Life:
    """Life of one bearing from its first turn on."""

    ageing: Ageing
    law: Growth
    share: float
    """Fatigue at which the spall begins [1]."""
    first: float
    """Length of the spall when it begins [m]."""

    @property
    def initiation(self) -> float:
        """Age at which the spall begins [s]."""
        return self.ageing.age_at("fatigue", self.share)

    def age_at(self, length: float) -> float:
        """Age at which the spall has a length in m [s]; that of its beginning if it begins longer."""
        begun = float(self.ageing.at("drive", self.initiation))
        return self.ageing.age_at("drive", begun + drive_between(self.law, self.first, max(length, self.first)))

    def length_at(self, age: ArrayLike) -> FloatArray:
        """Length of the spall at some ages [m]; 0 before it begins."""
        age, begun = np.asarray(age, np.float64), self.initiation
        drive = self.ageing.at("drive", age) - self.ageing.at("drive", begun)
        return np.where(age < begun, 0.0, length_after(self.law, self.first, np.maximum(drive, 0.0)))


def _sum(step: float, rate: NDArray[np.floating]) -> FloatArray:
    """Integral by trapezoids, 0 at the first step."""
    return np.concatenate([[0.0], np.cumsum(step * (rate[1:] + rate[:-1]) / 2)])


def _extended(at: ArrayLike, x: FloatArray, y: FloatArray) -> FloatArray:
    """Linear interpolation of rising ``y(x)`` from the origin on, extended at its mean slope."""
    at = np.asarray(at, np.float64)
    return np.where(at <= x[-1], np.interp(at, x, y), y[-1] + (at - x[-1]) * (y[-1] / x[-1]))
