"""Velocity and displacement of an acceleration, and the rms velocity that ISO 20816-3 judges.

A signal is integrated in the frequency domain: its Fourier coefficients are divided by ``2 pi i frequency``, once for
each integration [1]_. Division raises slow drift without limit, so a high-pass is part of the operation. The rms of the
velocity that ISO 20816 [2]_ judges is taken from the power spectral density through the filter of [3]_.

.. [1] R. B. Randall, *Vibration-based Condition Monitoring*, 2nd ed., Wiley, 2021, section 3.2.
.. [2] ISO 20816-3, *Mechanical vibration - Measurement and evaluation of machine vibration - Part 3: Industrial machinery
       with a power rating above 15 kW and operating speeds between 120 r/min and 30 000 r/min*, 2022.
.. [3] ISO 2954, *Mechanical vibration of rotating and reciprocating machinery - Requirements for instruments for measuring
       vibration severity*, 2012: Butterworth filters of third order, 3 dB down at the ends of the band.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import irfft, next_fast_len, rfft

from features.signal.arguments import as_records, check_positive, like, of_each
from features.signal.rows import FloatArray
from features.signal.spectra import psd

HIGH_PASS = 10.0  # Hz
SLOWEST, SLOW, FASTEST = 2.0, 10.0, 500.0  # Hz: 120, 600 and 30,000 r/min
VELOCITY_BAND, SLOW_VELOCITY_BAND = (10.0, 1000.0), (2.0, 1000.0)  # Hz, the second below 600 r/min
VELOCITY_PERIODS = 10.0  # of the lower end of the band, in a window of its spectrum and in the shortest signal


def velocity(x: ArrayLike, fs: float, high_pass: float = HIGH_PASS) -> FloatArray:
    """Velocity, from accelerations of shape (record, time), in their unit times seconds and of the same shape.

    The gain of the high-pass is 1 from ``high_pass`` on, 0 up to half of it, and rises as half a cosine in between. The
    signal counts as zero beyond its ends, which the high-pass spreads: of a sine that is cut there, the velocity errs by
    up to 2 % of its amplitude at 2 / ``high_pass`` seconds from an end, and by up to 0.3 % at 5 / ``high_pass``.

    Parameters
    ----------
    x
        Accelerations, shape (record, time).
    fs
        Sample rate [Hz].
    high_pass
        Lowest frequency that is kept whole [Hz].

    Raises
    ------
    ValueError
        If the high-pass is not between 0 and half the sample rate.
    """
    check_positive(fs=fs, high_pass=high_pass)
    return like(x, _integrate(as_records(x), fs, high_pass, 1))


def displacement(x: ArrayLike, fs: float, high_pass: float = HIGH_PASS) -> FloatArray:
    """Displacement, from accelerations of shape (record, time), in their unit times s²; as `velocity`."""
    check_positive(fs=fs, high_pass=high_pass)
    return like(x, _integrate(as_records(x), fs, high_pass, 2))


def _integrate(x: FloatArray, fs: float, high_pass: float, times: int) -> FloatArray:
    if not 0 < high_pass < fs / 2:
        raise ValueError(f"high_pass: {high_pass:g} Hz is not between 0 and half the sample rate, {fs / 2:g} Hz.")
    count = next_fast_len(x.shape[1] + round(fs / high_pass), real=True)  # zeros part the end from the start
    coefficients = np.asarray(rfft(x - x.mean(axis=1, keepdims=True), count, axis=1))
    frequency = np.arange(count // 2 + 1) * (fs / count)
    gain = 0.5 - 0.5 * np.cos(np.pi * np.clip(2 * frequency / high_pass - 1, 0, 1))
    response = gain / (2j * np.pi * np.maximum(frequency, fs / count)) ** times
    coefficients *= response.astype(coefficients.dtype)
    return np.asarray(irfft(coefficients, count, axis=1, overwrite_x=True))[:, : x.shape[1]]


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
