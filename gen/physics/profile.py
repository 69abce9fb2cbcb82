"""Change of speed or load over a record: interpolation between given points, linear or smooth.

Smooth interpolation uses the polynomial of degree five whose first two derivatives are zero at both ends, so that the acceleration of a
run-up is continuous.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Profile:
    """Shares of the nominal value at increasing times, constant before the first time and after the last."""

    times: tuple[float, ...]
    """From the start of the record [s]."""
    shares: tuple[float, ...]
    """[1]."""
    smooth: bool = False
    """True for smooth interpolation, False for linear interpolation."""


def share_at(profile: Profile, times: NDArray[np.floating]) -> FloatArray:
    """Share of the nominal value at ``times`` [s], of the shape of ``times`` [1].

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
    """Mean share over a record of ``duration`` [s]; 1 if there is no profile [1]."""
    if profile is None:
        return 1.0
    return float(share_at(profile, (np.arange(4096) + 0.5) * (duration / 4096)).mean())
