"""How a quantity changes over time between given points: linearly or smoothly.

Smooth means the polynomial of degree five whose first two derivatives are zero at both ends, so that a speed that runs up has a continuous
acceleration.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Profile:
    """Shares of a nominal value at rising times; constant before the first point and after the last."""

    times: tuple[float, ...]
    """From the start of the record [s]."""
    shares: tuple[float, ...]
    smooth: bool = False
    """Whether it changes smoothly between points."""


def share_at(profile: Profile, times: NDArray[np.floating]) -> FloatArray:
    """Share at ``times`` [s], of their shape [1].

    >>> [float(share) for share in share_at(Profile((0.0, 2.0), (1.0, 3.0), smooth=True), np.array([-1.0, 1.0, 5.0]))]
    [1.0, 2.0, 3.0]
    """
    knots, shares = np.asarray(profile.times), np.asarray(profile.shares)
    if not profile.smooth or len(knots) < 2:
        return np.asarray(np.interp(times, knots, shares))
    place = np.interp(times, knots, np.arange(len(knots)))
    at = np.minimum(place.astype(int), len(knots) - 2)
    part = place - at
    return shares[at] + (shares[at + 1] - shares[at]) * (part * part * part) * (10 - 15 * part + 6 * part**2)


def mean_share(profile: Profile | None, duration: float) -> float:
    """Mean share over the record, 1 without a profile [1]."""
    if profile is None:
        return 1.0
    return float(share_at(profile, (np.arange(4096) + 0.5) * (duration / 4096)).mean())


def turned(profile: Profile | None, times: FloatArray) -> FloatArray:
    """Integral of the share from the first of evenly spaced ``times`` on, of their shape [s]."""
    if profile is None:
        return times - times[0]
    step = times[1] - times[0]
    return np.concatenate([[0.0], np.cumsum(share_at(profile, times[:-1] + step / 2))]) * step
