"""Levels of a recording as analysts read them: rms, peak, crest factor, kurtosis, and rms of the velocity. Pure.

The velocity is integrated in the frequency domain: its power spectral density is that of the acceleration over
``(2 pi frequency)**2``, integrated over the band of ISO 20816 [1]_.

.. [1] ISO 20816-1, *Mechanical vibration - Measurement and evaluation of machine vibration*, 2016.
"""

from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray
from features.signal.spectra import psd

ACCELERATION = "m/s²"
VELOCITY_BAND = (10.0, 1000.0)  # Hz
VELOCITY_SECONDS = 1.0  # window of its spectrum, and the shortest signal


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
        In 10-1000 Hz [mm/s]; NaN if the unit is not m/s², the signal shorter than 1 s, or the sample rate 2000 Hz or less.
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


def levels_of(x: FloatArray, fs: float, recording: str, channel: str, unit: str) -> Levels:
    """Levels of a signal, shape (time,)."""
    mean = float(np.mean(x, dtype=float))
    centred = np.asarray(x, dtype=float) - mean
    rms, peak = float(np.std(centred)), float(np.abs(centred).max())
    constant = rms == 0
    crest = np.nan if constant else peak / rms
    kurtosis = np.nan if constant else float(np.mean((centred / rms) ** 4))
    velocity = 1e3 * velocity_rms(centred, fs) if unit == ACCELERATION else np.nan
    return Levels(recording, channel, unit, mean, rms, peak, crest, kurtosis, velocity)


def velocity_rms(x: FloatArray, fs: float) -> float:
    """Root mean square of the velocity in 10-1000 Hz [m/s] of an acceleration [m s-2], shape (time,); NaN as in `Levels`."""
    low, high = VELOCITY_BAND
    if len(x) < VELOCITY_SECONDS * fs or fs <= 2 * high:
        return np.nan
    frequencies, density = psd(x[None], fs, VELOCITY_SECONDS)
    band = (frequencies >= low) & (frequencies <= high)
    return float(np.sqrt(np.trapezoid(density[0, band] / (2 * np.pi * frequencies[band]) ** 2, frequencies[band])))
