"""Demodulation: bands of a record as analytic signals, the spectra of their envelopes, and the floor of those.

``Fourier coefficients -> analytic_band -> envelope_spectrum -> running_median``

A band is cut out of the Fourier coefficients of the whole record and transformed back alone, as a complex
baseband signal at twice the band's width [1]_. Its modulus is the envelope, and nothing in it depends on the
sample rate of the record. Records are rows, and no row knows of the others. The squared envelope spectrum is
[2]_, the interpolation between the coefficients of a Fourier transform [3]_.

.. [1] R. B. Randall, *Vibration-based Condition Monitoring*, 2nd ed., Wiley, 2021, section 3.3.
.. [2] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
.. [3] J. A. Fessler, B. P. Sutton, "Nonuniform fast Fourier transforms using min-max interpolation", *IEEE
       Trans. Signal Process.* 51 (2003) 560-574.
"""

import math
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import DTypeLike
from scipy.fft import ifft, next_fast_len, rfft

from features.signal.rows import ComplexArray, FloatArray, hann_window, row_kernel, squared_modulus, total

ZERO_PADDING = 4
INTERPOLATED = 1.125  # times the length of a signal: what a transform is padded to before it is interpolated
NEIGHBOURS = 8  # coefficients that a point between them is interpolated from
MEDIAN_POINTS = 64  # equally spaced over the window of the running median
MEDIAN_STEP = 0.25  # of that window


def analytic_band(coefficients: ComplexArray, low: int, high: int) -> ComplexArray:
    """Analytic signal of the bins ``low`` to ``high`` (not included), shifted down to zero frequency.

    It has as many samples a second as its length over the duration of the record, at least twice the width of
    the band: its squared modulus is free of aliasing.

    Parameters
    ----------
    coefficients
        Shape (record, frequency), as from `fourier_coefficients`, whitened or not.
    low, high
        Bins.

    Returns
    -------
    Shape (record, time), in the unit of the record; its modulus is the envelope of the band.
    """
    band = coefficients[:, low:high]
    return np.asarray(ifft(2 * band, n=next_fast_len(2 * max(1, band.shape[-1])), axis=-1, norm="forward"))


def envelope_spectrum(z: ComplexArray, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and amplitude spectrum of the envelope of analytic signals.

    Less its mean, Hann window, on a grid four times as fine as the resolution of a transform; a modulation of
    amplitude a in the envelope reads a.

    Parameters
    ----------
    z
        Analytic signals, shape (record, time).
    rate
        Their sample rate [Hz].

    Returns
    -------
    Shapes (frequency,) and (record, frequency). Divide the frequencies by a shaft rate to have orders.
    """
    return _amplitude_spectrum(np.sqrt(squared_modulus(z)), rate)


def squared_envelope_spectrum(z: ComplexArray, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and amplitude spectrum of the squared envelope, otherwise as `envelope_spectrum`."""
    return _amplitude_spectrum(squared_modulus(z), rate)


def _amplitude_spectrum(y: FloatArray, rate: float) -> tuple[FloatArray, FloatArray]:
    bins = ZERO_PADDING * y.shape[-1] // 2 + 1
    return np.arange(bins) * (rate / (ZERO_PADDING * y.shape[-1])), fine_amplitudes(hann_weighted(y), bins)


@row_kernel
def _less_mean(y: FloatArray, window: FloatArray) -> FloatArray:
    out = np.empty(y.shape, y.dtype)
    for row in range(len(y)):
        mean = y.dtype.type(total(y[row] * window) / total(window))
        for i in range(y.shape[1]):
            out[row, i] = (y[row, i] - mean) * window[i]
    return out


def hann_weighted(y: FloatArray) -> FloatArray:
    """Real signals less their mean under a Hann window, in which they sum to zero, shape (record, time)."""
    return _less_mean(y, hann_window(y.shape[-1], y.dtype))


def fine_amplitudes(weighted: FloatArray, bins: int) -> FloatArray:
    """First bins of the amplitude spectrum that zero-padding to four times the length would give.

    Interpolated by a Kaiser-Bessel kernel between the coefficients of the signals padded to `INTERPOLATED` of
    their length, within 1e-5 of the rms of the spectrum and in a quarter of the time.

    Parameters
    ----------
    weighted
        Signals under a Hann window, as from `hann_weighted`, shape (record, time).
    bins
        How many bins, at most as many as padding would give.

    Returns
    -------
    Shape (record, bins), in the unit of the signals.
    """
    n = weighted.shape[-1]
    window, first, weights = _interpolation(n, weighted.dtype)
    padded = np.zeros((len(weighted), len(window)), weighted.dtype)
    start = (len(window) - n) // 2
    np.multiply(weighted, window[start : start + n], out=padded[:, start : start + n])
    return _interpolated(np.asarray(rfft(padded, axis=-1)), len(window), first[:bins], weights[:bins])


@lru_cache(16)
def _interpolation(n: int, dtype: DTypeLike) -> tuple[FloatArray, np.ndarray, FloatArray]:
    """What to interpolate the spectrum of signals of length n with.

    The reciprocal of the transform of the kernel, shape (time,), scaled to read amplitudes under a Hann window;
    the first neighbour of each bin, shape (bin,), and the weights of all its neighbours, shape (bin, neighbour).
    """
    padded = next_fast_len(math.ceil(INTERPOLATED * n), real=True)
    bend = np.pi * NEIGHBOURS * (1 - 0.5 * n / padded)
    t = np.arange(padded) / padded - 0.5
    root = np.sqrt(np.maximum(bend**2 - (np.pi * NEIGHBOURS * t) ** 2, 1.0))  # at least 1 over the signal
    window = 4 / n * root / (NEIGHBOURS * np.sinh(root))
    place = np.arange(ZERO_PADDING * n // 2 + 1) * (padded / (ZERO_PADDING * n))
    first = np.floor(place).astype(np.intp) + 1 - NEIGHBOURS // 2
    neighbour = np.arange(NEIGHBOURS)
    offset = (place - first)[:, None] - neighbour
    weights = np.i0(bend * np.sqrt(1 - (2 * offset / NEIGHBOURS) ** 2)) * (-1.0) ** neighbour  # time zero is the middle
    return window.astype(dtype), first, weights.astype(dtype)


@njit(cache=True)  # in the order written: each lane of a vector is a record
def _interpolated(transform: ComplexArray, n: int, first: np.ndarray, weights: FloatArray) -> FloatArray:
    """Moduli between the coefficients of real signals of length n, shape (record, bin)."""
    records, reach = len(transform), first[-1] - first[0] + NEIGHBOURS
    real, imag = np.empty((reach, records), weights.dtype), np.empty((reach, records), weights.dtype)
    for row in range(records):
        for i in range(reach):
            k = (first[0] + i) % n
            c = transform[row, min(k, n - k)]
            real[i, row], imag[i, row] = c.real, c.imag if 2 * k <= n else -c.imag
    moduli = np.empty((len(first), records), weights.dtype)
    for k in range(len(first)):
        place = first[k] - first[0]
        re_near, im_near = real[place : place + NEIGHBOURS], imag[place : place + NEIGHBOURS]
        for row in range(records):
            re, im = weights.dtype.type(0.0), weights.dtype.type(0.0)
            for j in range(NEIGHBOURS):
                re += weights[k, j] * re_near[j, row]
                im += weights[k, j] * im_near[j, row]
            moduli[k, row] = np.sqrt(re * re + im * im)
    return moduli.T.copy()


def running_median(spectrum: FloatArray, width: FloatArray, bins: int) -> FloatArray:
    """Median of the surroundings of each of the first ``bins`` bins, over a window of ``width`` bins.

    Taken over 64 equally spaced points at every quarter of the window and interpolated linearly between,
    which costs the same for every length of record. At the ends the window stops and does not shrink.

    Parameters
    ----------
    spectrum
        Shape (record, frequency).
    width
        Width of the window in bins, one per record, shape (record,).
    bins
        How many bins to return.

    Returns
    -------
    Shape (record, bins).
    """
    last = spectrum.shape[-1] - 1
    width = np.minimum(width, last)
    step = np.maximum(MEDIAN_STEP * width, 1.0)
    knots = int(np.max(np.ceil((bins - 1) / step))) + 2
    window = _surroundings(spectrum, width, step, knots)
    window.sort(axis=-1)  # np.median costs eight times as much
    half = MEDIAN_POINTS // 2
    return _joined(0.5 * (window[..., half - 1] + window[..., half]), step, bins)


@row_kernel
def _surroundings(spectrum: FloatArray, width: FloatArray, step: FloatArray, knots: int) -> FloatArray:
    """Points of the window around each knot, shape (record, knot, point)."""
    out = np.empty((len(spectrum), knots, MEDIAN_POINTS), spectrum.dtype)
    last = spectrum.shape[1] - 1
    for row in range(len(spectrum)):
        half = width[row] / 2
        for knot in range(knots):
            centre = max(half, min(step[row] * knot, last - half))
            for point in range(MEDIAN_POINTS):
                place = centre + width[row] * (point / (MEDIAN_POINTS - 1) - 0.5)
                out[row, knot, point] = spectrum[row, int(np.rint(place))]
    return out


@row_kernel
def _joined(values: FloatArray, step: FloatArray, bins: int) -> FloatArray:
    """Straight lines between values ``step`` bins apart, shape (record, bins)."""
    out = np.empty((len(values), bins), values.dtype)
    for row in range(len(values)):
        for left in range(values.shape[1] - 1):
            rise = (values[row, left + 1] - values[row, left]) / step[row]
            for k in range(int(np.ceil(left * step[row])), min(int(np.ceil((left + 1) * step[row])), bins)):
                out[row, k] = values[row, left] + (k - left * step[row]) * rise
    return out
