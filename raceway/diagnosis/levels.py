"""Levels of a recording as analysts read them: rms, peak, crest factor, kurtosis, and rms of the velocity. Pure.

The velocity is that of `features.signal.velocity.velocity_rms`.
"""

from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray
from features.signal.shape import time_statistics
from features.signal.velocity import velocity_rms
from gen.support.units import from_si
from raceway.importing.recorded import ACCELERATION


class Levels(NamedTuple):
    """Levels of one channel without its mean.

    Attributes
    ----------
    recording, channel
        Names.
    unit
        Of mean, rms and peak.
    mean, rms, peak
        Mean that is taken away, root mean square, and largest deviation from the mean.
    crest_factor
        Peak over rms, NaN for a constant signal.
    kurtosis
        Fourth moment over the square of the second: 3 for Gaussian noise, NaN for a constant signal.
    velocity_rms_mm_s
        In the band of `velocity_rms` [mm/s]; NaN where it has none, or if the unit is not m/s².
    """

    recording: str
    channel: str
    unit: str
    mean: float
    rms: float
    peak: float
    crest_factor: float
    kurtosis: float
    velocity_rms_mm_s: float


def levels_of(x: FloatArray, fs: float, recording: str, channel: str, unit: str, shaft_rate: float) -> Levels:
    """Levels of a signal, shape (time,), of a machine whose shaft turns at a rate [Hz]."""
    mean = float(np.mean(x, dtype=float))
    centred = (np.asarray(x, dtype=float) - mean)[None]
    # a constant signal has no shape
    with np.errstate(invalid="ignore"):
        rms, peak, crest, kurtosis = time_statistics(centred)[0, :4].tolist()
    is_known = unit == ACCELERATION
    velocity = float(velocity_rms(centred, fs, np.array([shaft_rate]))[0]) if is_known else np.nan
    return Levels(recording, channel, unit, mean, rms, abs(peak), crest, kurtosis, from_si(velocity, "mm_s"))
