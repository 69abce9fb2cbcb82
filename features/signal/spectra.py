"""Power spectra and cepstra of vibration records, their Fourier coefficients, and three ways to whiten these.

Records are rows, and no row depends on the others. Cepstral pre-whitening is that of [1]_, linear prediction that of [2]_.

.. [1] P. Borghesani, P. Pennacchi, R. B. Randall, N. Sawalhi, R. Ricci, "Application of cepstrum
       pre-whitening for the diagnosis of bearing faults under variable speed conditions", *Mech. Syst. Signal
       Process.* 36 (2013) 370-384.
.. [2] J. Makhoul, "Linear prediction: a tutorial review", *Proc. IEEE* 63 (1975) 561-580.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, DTypeLike
from scipy.fft import irfft, rfft
from scipy.linalg import solve_toeplitz
from scipy.ndimage import uniform_filter1d

from features.signal.arguments import as_records, check_positive, like
from features.signal.rows import ComplexArray, FloatArray, hann_window, row_kernel, squared_modulus, total

TAPERED = 0.02  # fraction of a record that is tapered, half of it at each end
FAINTEST = 1e-6  # of the rms coefficient: a smaller coefficient is rounding error and must not be raised to one
LOADING = 1e-9  # of the power, added as white noise: it keeps the equations of pure tones solvable


def psd(x: ArrayLike, fs: float, segment: float = 0.25) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and one-sided power spectral density [unit of x squared per Hz] by Welch's method.

    Segments of ``segment`` seconds overlap by half; each has its mean subtracted and a Hann window applied.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    segment
        Length of a segment [s]; a record that is shorter is one segment.

    Returns
    -------
    Shapes (frequency,) and (record, frequency).
    """
    check_positive(fs=fs, segment=segment)
    frequencies, density = power_density(as_records(x), fs, segment)
    return frequencies, like(x, density)


def cepstrum(x: ArrayLike) -> FloatArray:
    """Real cepstrum, shape (record, time): value k belongs to the quefrency of k samples, and to the same from the end."""
    records = as_records(x)
    modulus = np.sqrt(squared_modulus(np.asarray(rfft(records, axis=-1))))
    logarithm = np.log(np.maximum(modulus, np.finfo(modulus.dtype).tiny))
    return like(x, np.asarray(irfft(logarithm, n=records.shape[-1], axis=-1)))


def power_density(x: FloatArray, fs: float, segment: float = 0.25) -> tuple[FloatArray, FloatArray]:
    """`psd` of records that are known to be such arrays."""
    n = x.shape[-1]
    length = min(n, max(2, round(min(segment * fs, n))))
    window = hann_window(length, x.dtype)
    transforms = np.asarray(rfft(_segments(x, window), axis=-1))
    power = squared_modulus(transforms.reshape(len(x), -1)).reshape(transforms.shape)
    density = power.mean(axis=1) * (2 / (fs * np.sum(window**2)))
    density[:, 0] *= 0.5
    if length % 2 == 0:
        density[:, -1] *= 0.5
    return np.arange(density.shape[-1]) * (fs / length), density


@row_kernel
def _segments(x: FloatArray, window: FloatArray) -> FloatArray:
    """Segments that overlap by half, without their mean, times a window, shape (record, segment, time)."""
    length = len(window)
    step = length - length // 2
    out = np.empty((x.shape[0], (x.shape[1] - length) // step + 1, length), x.dtype)
    for row in range(out.shape[0]):
        for number in range(out.shape[1]):
            segment = x[row, number * step : number * step + length]
            mean = x.dtype.type(total(segment) / length)
            for i in range(length):
                out[row, number, i] = (segment[i] - mean) * window[i]
    return out


def band_energies(density: FloatArray, frequencies: FloatArray, edges: ArrayLike) -> FloatArray:
    """Energy [unit of x squared] between neighbouring edges of a power spectral density.

    Each density value applies to a bin of one resolution around its frequency. An edge inside a bin divides the energy
    of the bin, so that the energies of adjacent bands add up to that of their union. There is no energy beyond the
    frequencies.

    Parameters
    ----------
    density
        Shape (record, frequency), equally spaced from 0.
    frequencies
        Shape (frequency,) [Hz].
    edges
        Ascending [Hz], shape (edge,) for all records, or (record, edge).

    Returns
    -------
    Shape (record, band), one band fewer than edges.
    """
    resolution = frequencies[1] - frequencies[0]
    bins = np.clip(np.asarray(edges, dtype=float) / resolution + 0.5, 0, density.shape[1])
    below, place = np.zeros((len(density), density.shape[1] + 1)), np.arange(density.shape[1] + 1)
    np.cumsum(density, axis=1, out=below[:, 1:])
    rows = zip(np.broadcast_to(bins, (len(density), bins.shape[-1])), below, strict=True)
    return np.diff([np.interp(edge, place, row) for edge, row in rows]) * resolution


def fourier_coefficients(x: FloatArray, fs: float, top: float) -> ComplexArray:
    """Fourier coefficients of whole records without their mean, up to ``top`` [Hz].

    Coefficient k belongs to the frequency ``k * fs / x.shape[-1]``. Both ends of the record are tapered, because
    whitening would turn the step from the last to the first sample into an impact: a tone ten times above the noise
    doubled the kurtosis of a band far above the tone. The inverse transform is the record itself between its tapered
    ends. A sine of amplitude a at the centre of a bin therefore gives 0.99 a / 2: the mean of the taper is 0.99.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    top
        Highest frequency kept [Hz].

    Returns
    -------
    Shape (record, frequency).
    """
    n = x.shape[-1]
    taper = _taper(n, x.dtype)
    coefficients = np.asarray(rfft((x - x.mean(axis=-1, keepdims=True)) * taper, axis=-1))
    return coefficients[:, : min(int(top * n / fs), n // 2) + 1]


@lru_cache(8)
def _taper(n: int, dtype: DTypeLike) -> FloatArray:
    place = np.arange(n)
    within = np.minimum(place, n - place) / (0.5 * TAPERED * n)
    # a Tukey window, one between its ends: divided by its sum, it raised envelopes by 1 %
    return ((0.5 - 0.5 * np.cos(np.pi * np.minimum(within, 1))) / n).astype(dtype)


def sine_windowed(x: FloatArray, length: int) -> ComplexArray:
    """Fourier coefficients of whole records without their mean under a sine window, padded to ``length``, shape (record, frequency)."""
    window = np.sqrt(hann_window(x.shape[-1], x.dtype))
    return np.asarray(rfft((x - x.mean(axis=-1, keepdims=True)) * window, n=length, axis=-1))


def prediction_filters(coefficients: ComplexArray, length: int, order: int) -> FloatArray:
    """Filters whose output is what ``order`` samples before do not predict, shape (record, order + 1), the first value 1.

    They solve the equations of Yule and Walker [2]_. Without a window, a tone of 100 times the noise left 1.4 times the
    power of the noise, because its correlation falls with the delay; under a sine window 1.04 times.

    Parameters
    ----------
    coefficients
        As of `sine_windowed`.
    length
        Its length, at least that of the records plus ``order``.
    order
        Number of samples.
    """
    power = squared_modulus(coefficients).astype(float)
    correlation = np.asarray(irfft(power, n=length, axis=-1))[:, : order + 1]
    correlation[:, 0] += LOADING * correlation[:, 0] + np.finfo(float).tiny
    weights = np.stack([solve_toeplitz(row[:-1], row[1:]) for row in correlation])
    return np.concatenate([np.ones((len(weights), 1)), -weights], axis=-1).astype(coefficients.real.dtype)


def whiten_cepstrally(coefficients: ComplexArray) -> ComplexArray:
    """Coefficients of modulus one with unchanged phases, shape (record, frequency)."""
    if np.asarray(coefficients).dtype.kind != "c" or not np.isfinite(coefficients).all():
        raise ValueError("coefficients: give finite complex numbers, as of a Fourier transform.")
    rows = np.atleast_2d(coefficients)
    return like(coefficients, _divide(rows, squared_modulus(rows)))


def whiten_by_psd(coefficients: ComplexArray, width: int) -> ComplexArray:
    """Coefficients divided by the root of their mean power over ``width`` bins, shape (record, frequency)."""
    mean = uniform_filter1d(squared_modulus(coefficients), max(1, width), axis=1, mode="mirror")
    return _divide(coefficients, np.maximum(mean, 0))  # the rounding of its sum may leave less than nothing


@row_kernel
def _divide(coefficients: ComplexArray, power: FloatArray) -> ComplexArray:
    """Coefficients divided by the root of a power, with `FAINTEST` as the lower bound of the root."""
    out = np.empty(coefficients.shape, coefficients.dtype)
    tiny = np.finfo(power.dtype).tiny
    for row in range(len(power)):
        least = power.dtype.type(FAINTEST * np.sqrt(total(power[row]) / power.shape[1]) + tiny)
        for k in range(power.shape[1]):
            out[row, k] = coefficients[row, k] * (1 / max(np.sqrt(power[row, k]), least))
    return out
