"""The rms velocity that ISO 20816-3 judges, of an acceleration.

It is the root of the integral of the power spectral density over ``(2 pi frequency)**2`` [1]_, through the filter of [2]_:
division raises slow drift without limit.

.. [1] ISO 20816-3, *Mechanical vibration - Measurement and evaluation of machine vibration - Part 3: Industrial machinery
       with a power rating above 15 kW and operating speeds between 120 r/min and 30 000 r/min*, 2022.
.. [2] ISO 2954, *Mechanical vibration of rotating and reciprocating machinery - Requirements for instruments for measuring
       vibration severity*, 2012: Butterworth filters of third order, 3 dB down at the ends of the band.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from features.signal.arguments import as_records, check_positive, like, of_each
from features.signal.rows import FloatArray
from features.signal.spectra import psd

SLOWEST, SLOW, FASTEST = 2.0, 10.0, 500.0  # Hz: 120, 600 and 30,000 r/min
VELOCITY_BAND, SLOW_VELOCITY_BAND = (10.0, 1000.0), (2.0, 1000.0)  # Hz, the second below 600 r/min
VELOCITY_PERIODS = 10.0  # of the lower end of the band, in a window of its spectrum and in the shortest signal


def velocity_band(shaft_rate: float) -> tuple[float, float]:
    """Ends of the band of the velocity that ISO 20816-3 judges [Hz], from the rate of the slowest shaft [Hz]."""
    return SLOW_VELOCITY_BAND if shaft_rate < SLOW else VELOCITY_BAND


def velocity_rms(x: ArrayLike, fs: float, shaft_rate: ArrayLike) -> FloatArray:
    """Root mean square of the velocity [m/s] in the band of ISO 20816-3, shape (record,).

    The band is 10-1000 Hz, and 2-1000 Hz below 600 r/min. A sine at one of its ends reads 0.71 of its value, one an
    octave beyond 0.12, as of the filters of ISO 2954.

    Parameters
    ----------
    x
        Accelerations [m/s²], shape (record, time).
    fs
        Sample rate [Hz].
    shaft_rate
        Rate of the slowest shaft of the machine [Hz], one for all records or of shape (record,).

    Returns
    -------
    NaN for signals shorter than 1 s, or 5 s below 600 r/min, for a sample rate of 2000 Hz or less, and for a shaft outside 120
    to 30,000 r/min, which the standard does not cover.
    """
    check_positive(fs=fs)
    records = as_records(x)
    rate = of_each(shaft_rate, "shaft_rate", records)
    covered, slow = (rate >= SLOWEST) & (rate <= FASTEST), rate < SLOW
    out = np.full(len(records), np.nan)
    for rows, (low, high) in ((covered & slow, SLOW_VELOCITY_BAND), (covered & ~slow, VELOCITY_BAND)):
        if rows.any() and fs > 2 * high and records.shape[1] * low >= VELOCITY_PERIODS * fs:
            out[rows] = _velocity_rms(records[rows], fs, low, high)
    return like(x, out)


def _velocity_rms(x: FloatArray, fs: float, low: float, high: float) -> FloatArray:
    frequencies, density = psd(x, fs, VELOCITY_PERIODS / low)
    above = frequencies[1:]
    gain = 1 / ((1 + (low / above) ** 6) * (1 + (above / high) ** 6) * (2 * np.pi * above) ** 2)
    return np.sqrt(np.sum(density[:, 1:] * gain, axis=1) * frequencies[1])
