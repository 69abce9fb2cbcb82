"""Spectra of vibration records: power, whitened bands as analytic signals, and their envelopes.

``signal -> fourier_coefficients -> a whitened slice -> analytic_band -> envelope_spectrum -> running_median``

A band is cut out of the Fourier coefficients of the whole record and transformed back alone, as a complex
baseband signal at twice the band's width [1]_. Its modulus is the envelope, and nothing in it depends on the
sample rate of the record. Records are rows: every function works on all of them at once, in the precision it
is given, and no row knows of the others. Cepstral pre-whitening is [2]_, the squared envelope spectrum [3]_,
the interpolation between the coefficients of a Fourier transform [4]_.

.. [1] R. B. Randall, *Vibration-based Condition Monitoring*, 2nd ed., Wiley, 2021, section 3.3.
.. [2] P. Borghesani, P. Pennacchi, R. B. Randall, N. Sawalhi, R. Ricci, "Application of cepstrum
       pre-whitening for the diagnosis of bearing faults under variable speed conditions", *Mech. Syst. Signal
       Process.* 36 (2013) 370-384.
.. [3] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
.. [4] J. A. Fessler, B. P. Sutton, "Nonuniform fast Fourier transforms using min-max interpolation", *IEEE
       Trans. Signal Process.* 51 (2003) 560-574.
"""

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, DTypeLike, NDArray
from scipy.fft import ifft, next_fast_len, rfft
from scipy.signal.windows import hann, tukey

FloatArray = NDArray[np.floating[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]

TAPERED = 0.02  # of a record, half of it at each end
ZERO_PADDING = 4
INTERPOLATED = 1.125  # times the length of a signal: what a transform is padded to before it is interpolated
NEIGHBOURS = 8  # coefficients that a point between them is interpolated from
FAINTEST = 1e-6  # of the rms coefficient: below, a coefficient is rounding error and is not whitened
MEDIAN_POINTS = 64  # equally spaced over the window of the running median
MEDIAN_STEP = 0.25  # of that window

row_kernel = njit(cache=True, error_model="numpy", fastmath={"nnan", "nsz"})
"""Compiles a loop over records. Not with "reassoc": code from the cache then differed in a last bit from code just compiled."""

LANES = 16


@row_kernel
def total(values: FloatArray) -> float:
    """Sum in double precision, in lanes that a processor adds at once and in an order that is always the same."""
    lanes = np.zeros(LANES)
    whole = len(values) // LANES * LANES
    for start in range(0, whole, LANES):
        for lane in range(LANES):
            lanes[lane] += values[start + lane]
    found = 0.0
    for lane in range(LANES):
        found += lanes[lane]
    for i in range(whole, len(values)):
        found += values[i]
    return found


@row_kernel
def centred(x: FloatArray) -> FloatArray:
    """Records less their mean, in single precision, shape (record, time)."""
    out = np.empty(x.shape, np.float32)
    for row in range(len(x)):
        mean = total(x[row]) / x.shape[1]
        for i in range(x.shape[1]):
            out[row, i] = x[row, i] - mean
    return out


def psd(x: FloatArray, fs: float, segment: float = 0.25) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and one-sided power spectral density [unit of x squared per Hz] by Welch's method.

    Hann windows of ``segment`` seconds, overlapping by half, each less its mean.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    segment
        Length of a window [s]; a shorter record is one window.

    Returns
    -------
    Shapes (frequency,) and (record, frequency).
    """
    n = x.shape[-1]
    length = min(n, max(2, round(segment * fs)))
    window = _hann(length, x.dtype)
    transforms = np.asarray(rfft(_segments(x, window), axis=-1))
    density = _mean_power(transforms) * (2 / (fs * np.sum(window**2)))
    density[:, 0] *= 0.5
    if length % 2 == 0:
        density[:, -1] *= 0.5
    return np.arange(density.shape[-1]) * (fs / length), density


@row_kernel
def _segments(x: FloatArray, window: FloatArray) -> FloatArray:
    """Segments overlapping by half, less their mean, under a window, shape (record, segment, time)."""
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


@row_kernel
def _mean_power(coefficients: ComplexArray) -> FloatArray:
    """Mean square over the middle axis, shape (record, frequency)."""
    out = np.zeros((coefficients.shape[0], coefficients.shape[2]), coefficients.real.dtype)
    for row in range(coefficients.shape[0]):
        for number in range(coefficients.shape[1]):
            for k in range(coefficients.shape[2]):
                c = coefficients[row, number, k]
                out[row, k] += c.real**2 + c.imag**2
    out /= coefficients.shape[1]
    return out


def band_energies(density: FloatArray, frequencies: FloatArray, edges: ArrayLike) -> FloatArray:
    """Energy [unit of x squared] between neighbouring edges of a power spectral density.

    Each density stands for the bin of one resolution around its frequency, and an edge inside a bin divides
    it, so that adjoining bands add up to the energy of their union. Nothing lies outside the frequencies.

    Parameters
    ----------
    density
        Shape (record, frequency), equally spaced from 0.
    frequencies
        Shape (frequency,) [Hz].
    edges
        Ascending [Hz], shape (edge,), or (record, edge) as from orders times ``shaft_rate[:, None]``.

    Returns
    -------
    Shape (record, band), one band fewer than edges.
    """
    resolution = frequencies[1] - frequencies[0]
    bins = np.clip(np.asarray(edges, dtype=float) / resolution + 0.5, 0, density.shape[1])
    return _sums_between(density, np.broadcast_to(bins, (len(density), bins.shape[-1]))) * resolution


@row_kernel
def _sums_between(values: FloatArray, bins: FloatArray) -> FloatArray:
    """Sums of values from one place between bins to the next, shape (record, place - 1)."""
    out = np.empty((len(values), bins.shape[1] - 1))
    for row in range(len(values)):
        for band in range(out.shape[1]):
            start, stop = bins[row, band], bins[row, band + 1]
            first, last = int(start), int(stop)
            found = total(values[row, first:last])
            if first < values.shape[1]:
                found -= (start - first) * values[row, first]
            if last < values.shape[1]:
                found += (stop - last) * values[row, last]
            out[row, band] = found
    return out


def fourier_coefficients(x: FloatArray, fs: float, top: float) -> ComplexArray:
    """Fourier coefficients of whole records less their mean, up to ``top`` [Hz].

    Coefficient k belongs to the frequency ``k * fs / shape[-1]``; a sine of amplitude a in the middle of a
    bin reads a / 2. The ends are tapered: the jump from the last sample to the first one looks like an impact
    once the spectrum is whitened, and a tone ten times above the noise was enough to double the kurtosis of a
    band far above it.

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
    taper = tukey(n, TAPERED, sym=False)
    return (taper / taper.sum()).astype(dtype)


@lru_cache(32)
def _hann(n: int, dtype: DTypeLike) -> FloatArray:
    return hann(n, sym=False).astype(dtype)


@row_kernel
def squared_modulus(z: ComplexArray) -> FloatArray:
    """Square of the modulus, in the shape (record, time) or (record, frequency) of its argument."""
    out = np.empty(z.shape, z.real.dtype)
    for row in range(z.shape[0]):
        for i in range(z.shape[1]):
            out[row, i] = z[row, i].real ** 2 + z[row, i].imag ** 2
    return out


def cepstrally_whitened(coefficients: ComplexArray) -> ComplexArray:
    """Coefficients of modulus one with their phases kept, shape (record, frequency)."""
    return _divided(coefficients, squared_modulus(coefficients))


def psd_whitened(coefficients: ComplexArray, width: int) -> ComplexArray:
    """Coefficients divided by the root of their mean power over ``width`` bins, shape (record, frequency)."""
    return _divided(coefficients, _running_mean(squared_modulus(coefficients), max(1, width)))


@row_kernel
def _divided(coefficients: ComplexArray, power: FloatArray) -> ComplexArray:
    """Coefficients over the root of a power, which is nowhere taken fainter than `FAINTEST` allows."""
    out = np.empty(coefficients.shape, coefficients.dtype)
    tiny = np.finfo(power.dtype).tiny
    for row in range(len(power)):
        least = power.dtype.type(FAINTEST * np.sqrt(total(power[row]) / power.shape[1]) + tiny)
        for k in range(power.shape[1]):
            out[row, k] = coefficients[row, k] * (1 / max(np.sqrt(power[row, k]), least))
    return out


@row_kernel
def _running_mean(power: FloatArray, width: int) -> FloatArray:
    """Mean over ``width`` bins around each, mirrored at the first and the last bin, shape (record, frequency)."""
    n = power.shape[1]
    place = np.abs(np.arange(n + width) - width // 2) % max(2 * (n - 1), 1)
    place = np.minimum(place, 2 * (n - 1) - place)
    mirrored = np.empty(n + width)
    out = np.empty(power.shape, power.dtype)
    for row in range(len(power)):
        for i in range(n + width):
            mirrored[i] = power[row, place[i]]
        within = total(mirrored[:width])
        for i in range(n):
            out[row, i] = max(within, 0.0) / width
            within += mirrored[i + width] - mirrored[i]
    return out


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
    return _less_mean(y, _hann(y.shape[-1], y.dtype))


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
