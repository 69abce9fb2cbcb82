"""Demodulation: analytic signals of frequency bands, the spectra of their envelopes, and the floor of these spectra.

``Fourier coefficients -> analytic_band -> envelope_spectrum -> running_median``

The inverse transform of the Fourier coefficients of one band is a complex baseband signal, sampled at twice the width
of the band [1]_. Its modulus is the envelope, which does not depend on the sample rate of the record. Records are rows,
and no row depends on the others. The squared envelope spectrum is that of [2]_, the interpolation between Fourier
coefficients that of [3]_.

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

from features.signal.rows import (
    ComplexArray,
    FloatArray,
    by_row,
    hann_window,
    on_disk,
    row_kernel,
    squared_modulus,
    total,
)

ZERO_PADDING = 4
INTERPOLATED = 1.125  # length of the transform that is interpolated, in lengths of the signal
NEIGHBOURS = 8  # coefficients in each interpolation
MEDIAN_POINTS = 64  # points of the running median, equally spaced over its window
MEDIAN_STEP = 0.25  # distance between two medians, in windows


def analytic_band(coefficients: ComplexArray, low: int, high: int) -> ComplexArray:
    """Analytic signal of the bins ``low`` to ``high`` (exclusive), shifted to zero frequency.

    Its sample rate is its length divided by the duration of the record, at least twice the width of the band, so that
    its squared modulus has no aliasing.

    Parameters
    ----------
    coefficients
        Shape (record, frequency), as from `fourier_coefficients`, whitened or not.
    low, high
        First bin of the band, and the bin after its last.

    Returns
    -------
    Shape (record, time), in the unit of the record; its modulus is the envelope of the band.
    """
    band = coefficients[:, low:high]
    return by_row(ifft, 2 * band, next_fast_len(2 * max(1, band.shape[-1])), norm="forward")


def envelope_spectrum(z: ComplexArray, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and amplitude spectrum of the envelope of analytic signals.

    The mean is subtracted and a Hann window applied; the grid is four times finer than the resolution of the signal. A
    modulation of amplitude a in the envelope, at a frequency of the grid, gives a line of height a. Halfway between two
    frequencies of the grid the line is 1.0 % lower.

    Parameters
    ----------
    z
        Analytic signals, shape (record, time).
    rate
        Their sample rate [Hz].

    Returns
    -------
    Shapes (frequency,) and (record, frequency).
    """
    return amplitude_spectrum(np.sqrt(squared_modulus(z)), rate)


def amplitude_spectrum(y: FloatArray, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and amplitude spectrum of real signals, else as `envelope_spectrum`."""
    bins = ZERO_PADDING * y.shape[-1] // 2 + 1
    return np.arange(bins) * (rate / (ZERO_PADDING * y.shape[-1])), fine_amplitudes(weight_by_hann(y), bins)


@row_kernel
def _less_mean(y: FloatArray, window: FloatArray) -> FloatArray:
    out = np.empty(y.shape, y.dtype)
    for row in range(len(y)):
        mean = y.dtype.type(total(y[row] * window) / total(window))
        for i in range(y.shape[1]):
            out[row, i] = (y[row, i] - mean) * window[i]
    return out


def weight_by_hann(y: FloatArray) -> FloatArray:
    """Real signals without their Hann-weighted mean, times the Hann window, shape (record, time)."""
    return _less_mean(y, hann_window(y.shape[-1], y.dtype))


def fine_amplitudes(weighted: FloatArray, bins: int) -> FloatArray:
    """First bins of the amplitude spectrum of signals that are zero-padded to four times their length.

    A Kaiser-Bessel kernel interpolates between the coefficients of signals padded to `INTERPOLATED` times their length.
    The error is below 1e-5 of the rms of the spectrum; the computation takes a quarter of the time of the padded one.

    Parameters
    ----------
    weighted
        Signals times a Hann window, as from `weight_by_hann`, shape (record, time).
    bins
        Number of bins, at most as many as the padded spectrum has.

    Returns
    -------
    Shape (record, bins), in the unit of the signals.
    """
    n = weighted.shape[-1]
    window, first, weights = _interpolation(n, bins, weighted.dtype)
    padded = np.zeros((len(weighted), len(window)), weighted.dtype)
    start = (len(window) - n) // 2
    np.multiply(weighted, window[start : start + n], out=padded[:, start : start + n])
    return _interpolate(np.asarray(rfft(padded, axis=-1)), len(window), first, weights)


@lru_cache(32)  # 16 levels of a tree of bands, with two lengths each
def _interpolation(n: int, bins: int, dtype: DTypeLike) -> tuple[FloatArray, np.ndarray, FloatArray]:
    """Window, first neighbours and weights of the interpolation of the first bins of spectra of signals of length n.

    The window, shape (time,), is the reciprocal of the transform of the kernel, scaled so that the result is the amplitude
    under a Hann window. Each bin has its first neighbour, shape (bin,), and a weight per neighbour, shape (bin, neighbour).
    """
    padded = next_fast_len(math.ceil(INTERPOLATED * n), real=True)
    bend = np.pi * NEIGHBOURS * (1 - 0.5 * n / padded)
    t = np.arange(padded) / padded - 0.5
    root = np.sqrt(np.maximum(bend**2 - (np.pi * NEIGHBOURS * t) ** 2, 1.0))  # above 1 within the signal
    window = 4 / n * root / (NEIGHBOURS * np.sinh(root))
    place = np.arange(bins) * (padded / (ZERO_PADDING * n))
    first = np.floor(place).astype(np.intp) + 1 - NEIGHBOURS // 2
    neighbour = np.arange(NEIGHBOURS)
    offset = (place - first)[:, None] - neighbour
    weights = (
        np.i0(bend * np.sqrt(1 - (2 * offset / NEIGHBOURS) ** 2)) * (-1.0) ** neighbour
    )  # time zero is the middle of the signal
    return window.astype(dtype), first, weights.astype(dtype)


@on_disk
@njit(nogil=True)  # without fastmath: vectorised over records, each sum in the order written
def _interpolate(transform: ComplexArray, n: int, first: np.ndarray, weights: FloatArray) -> FloatArray:
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
    """Running median of spectra over ``width`` bins, at their first ``bins`` bins.

    Medians of 64 equally spaced points are taken at every quarter of the window and interpolated linearly, so that the
    cost does not depend on the width of the window in bins. At both ends of the spectrum the window stops and keeps its
    width.

    Parameters
    ----------
    spectrum
        Shape (record, frequency).
    width
        Width of the window in bins, one per record, shape (record,).
    bins
        Number of bins to return.

    Returns
    -------
    Shape (record, bins).
    """
    last = spectrum.shape[-1] - 1
    width = np.minimum(width, last)
    step = np.maximum(MEDIAN_STEP * width, 1.0)
    knots = int(np.max(np.ceil((bins - 1) / step))) + 2
    window = _surroundings(spectrum, width, step, knots)
    window.sort(axis=-1)  # np.median takes eight times as long
    half = MEDIAN_POINTS // 2
    return _join(0.5 * (window[..., half - 1] + window[..., half]), step, bins)


def spectrum_over_floor(y: FloatArray, width: FloatArray, bins: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Real signals under a Hann window, their amplitude spectrum, and its `log_level` at the first ``bins`` bins, or fewer.

    ``width`` is that of `log_level`.
    """
    # leakage of the mean and of strong lines would hide weak ones
    weighted, end = weight_by_hann(y), ZERO_PADDING * y.shape[-1] // 2 + 1
    # spectra are cut behind the window of the highest bin
    spectrum = fine_amplitudes(weighted, min(bins + int(width.max()) + 4, end))
    return weighted, spectrum, log_level(spectrum, width, min(bins, end))


def log_level(spectrum: FloatArray, width: FloatArray, bins: int) -> FloatArray:
    """Logarithm of the ratio of envelope spectra to their running median, shape (record, bins).

    ``width`` is the width of the median window in bins, shape (record,). The spectra must extend at least this width
    beyond the first ``bins`` bins, or to their end.
    """
    floor = running_median(spectrum, width, bins)
    least = np.finfo(spectrum.dtype).tiny
    return np.log(np.maximum(spectrum[:, :bins], least) / np.maximum(floor, least))


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
def _join(values: FloatArray, step: FloatArray, bins: int) -> FloatArray:
    """Straight lines between values ``step`` bins apart, shape (record, bins)."""
    out = np.empty((len(values), bins), values.dtype)
    for row in range(len(values)):
        for left in range(values.shape[1] - 1):
            rise = (values[row, left + 1] - values[row, left]) / step[row]
            for k in range(int(np.ceil(left * step[row])), min(int(np.ceil((left + 1) * step[row])), bins)):
                out[row, k] = values[row, left] + (k - left * step[row]) * rise
    return out
