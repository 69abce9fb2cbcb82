"""Levels of a recording as analysts read them: rms, peak, crest factor, kurtosis, and rms of the velocity. Pure.

The velocity is that of `features.signal.velocity.velocity_rms`.
"""

from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray
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
    centred = np.asarray(x, dtype=float) - mean
    rms, peak = float(np.std(centred)), float(np.abs(centred).max())
    # a constant signal has no shape
    constant = rms == 0
    crest = np.nan if constant else peak / rms
    kurtosis = np.nan if constant else float(np.mean((centred / rms) ** 4))
    velocity = (
        from_si(float(velocity_rms(centred[None], fs, np.array([shaft_rate]))[0]), "mm_s")
        if unit == ACCELERATION
        else np.nan
    )
    return Levels(recording, channel, unit, mean, rms, peak, crest, kurtosis, velocity)
