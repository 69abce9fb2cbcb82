"""Spectra of vibration records: power, whitened bands as analytic signals, and their envelopes.

``signal -> fourier_coefficients -> a whitened slice -> analytic_band -> envelope_spectrum -> running_median``

A band is cut out of the Fourier coefficients of the whole record and transformed back alone, as a complex
baseband signal at twice the band's width [1]_. Its modulus is the envelope, and nothing in it depends on the
sample rate of the record. Records are rows: every function works on all of them at once. Cepstral
pre-whitening is [2]_, the squared envelope spectrum [3]_.

.. [1] R. B. Randall, *Vibration-based Condition Monitoring*, 2nd ed., Wiley, 2021, section 3.3.
.. [2] P. Borghesani, P. Pennacchi, R. B. Randall, N. Sawalhi, R. Ricci, "Application of cepstrum
       pre-whitening for the diagnosis of bearing faults under variable speed conditions", *Mech. Syst. Signal
       Process.* 36 (2013) 370-384.
.. [3] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import ifft, next_fast_len, rfft, rfftfreq
from scipy.ndimage import uniform_filter1d
from scipy.signal import welch
from scipy.signal.windows import hann, tukey

FloatArray = NDArray[np.floating[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]

TAPERED = 0.02  # of a record, half of it at each end
ZERO_PADDING = 4
FAINTEST = 1e-9  # of the rms coefficient: below, a coefficient is rounding error and is not whitened
MEDIAN_POINTS = 64  # equally spaced over the window of the running median
MEDIAN_STEP = 0.25  # of that window


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
    length = min(x.shape[-1], max(2, round(segment * fs)))
    return welch(x, fs, window="hann", nperseg=length, detrend="constant", axis=-1)


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
    below = np.zeros((density.shape[0], density.shape[1] + 1))
    np.cumsum(density * resolution, axis=-1, out=below[:, 1:])
    bins = np.clip(np.asarray(edges, dtype=float) / resolution + 0.5, 0, density.shape[1])
    bins = np.broadcast_to(bins, (density.shape[0], bins.shape[-1]))
    return np.diff(at_bins(below, bins), axis=-1)


def at_bins(values: FloatArray, bins: FloatArray) -> FloatArray:
    """Values between bins by linear interpolation, shape (record, point).

    ``values`` has the shape (record, bin), ``bins`` the shape (record, point).
    """
    left = np.clip(bins.astype(np.intp), 0, values.shape[-1] - 2)
    lower = np.take_along_axis(values, left, axis=-1)
    upper = np.take_along_axis(values, left + 1, axis=-1)
    return lower + (bins - left) * (upper - lower)


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
    taper = tukey(n, TAPERED, sym=False)
    coefficients = np.asarray(rfft((x - x.mean(axis=-1, keepdims=True)) * (taper / taper.sum()), axis=-1))
    return coefficients[:, : min(int(top * n / fs), n // 2) + 1]


def cepstrally_whitened(coefficients: ComplexArray) -> ComplexArray:
    """Coefficients of modulus one with their phases kept, shape (record, frequency)."""
    return coefficients / _at_least_faintest(np.abs(coefficients))


def psd_whitened(coefficients: ComplexArray, width: int) -> ComplexArray:
    """Coefficients divided by the root of their mean power over ``width`` bins, shape (record, frequency)."""
    power = coefficients.real**2 + coefficients.imag**2
    smooth = uniform_filter1d(power, max(1, width), axis=-1, mode="mirror")
    return coefficients / _at_least_faintest(np.sqrt(np.maximum(smooth, 0.0)))


def _at_least_faintest(modulus: FloatArray) -> FloatArray:
    rms = np.sqrt(np.mean(modulus**2, axis=-1, keepdims=True))
    return np.maximum(modulus, FAINTEST * rms + np.finfo(modulus.dtype).tiny)


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

    Less its mean, Hann window, zero-padded to four times its length; a modulation of amplitude a in the
    envelope reads a.

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
    return _amplitude_spectrum(np.abs(z), rate)


def squared_envelope_spectrum(z: ComplexArray, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and amplitude spectrum of the squared envelope, otherwise as `envelope_spectrum`."""
    return _amplitude_spectrum(z.real**2 + z.imag**2, rate)


def _amplitude_spectrum(y: FloatArray, rate: float) -> tuple[FloatArray, FloatArray]:
    window = hann(y.shape[-1], sym=False).astype(y.dtype)
    weighted = y * window  # and not y @ window: BLAS rounds a record by the company it is in
    weighted -= weighted.sum(axis=-1, keepdims=True) / window.sum() * window
    n = ZERO_PADDING * y.shape[-1]
    transform = np.asarray(rfft(weighted, n=n, axis=-1))
    return rfftfreq(n, 1 / rate), np.abs(transform) * (2 / window.sum())


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
    width = np.minimum(width, last)[:, None]
    step = np.maximum(MEDIAN_STEP * width, 1.0)
    centres = step * np.arange(int(np.max(np.ceil((bins - 1) / step))) + 2)
    centres = np.clip(centres, width / 2, last - width / 2)
    spread = np.linspace(-0.5, 0.5, MEDIAN_POINTS)
    points = np.rint(centres[..., None] + width[..., None] * spread).astype(np.intp)
    window = np.take_along_axis(spectrum, points.reshape(len(points), -1), axis=-1).reshape(points.shape)
    window.sort(axis=-1)  # np.median costs eight times as much
    half = MEDIAN_POINTS // 2
    return at_bins(0.5 * (window[..., half - 1] + window[..., half]), np.arange(bins) / step)
