"""Cyclostationarity: spectral coherence of records, and enhanced envelope spectra.

The power of an impact train rises and falls at its rate alpha, so that the Fourier coefficients X of the record at f and
f + alpha are correlated. The coherence is this correlation, averaged over a band of width B around f [1]_ [2]_::

    |gamma|^2 = |sum X(f + alpha) X*(f)|^2 / (sum |X(f + alpha)|^2  sum |X(f)|^2)

The sum over a band, for all cyclic frequencies at once, is a correlation of the coefficients, computed by FFT: the
frequency-smoothed cyclic periodogram, exact at every cyclic frequency. Estimates from short transforms [3]_ need as much
time and are attenuated towards half the rate of their segments. The record is under a sine window, so that the products
are under a Hann window: a line in alpha is two resolutions wide on each side, and a coefficient is independent of those
1.5 resolutions away. In stationary noise ``|gamma|^2`` of K independent coefficients exceeds c with the probability
``(1 - c)**(K - 1)`` [4]_. Inside a resonance, few coefficients would carry the sum: of values that exceed c with a nominal
probability of 0.001, there were 0.05 at a damping of 0.2 %. So the record is first whitened by linear prediction from the
time ``1 / B`` before [5]_, which takes resonances away. The mean of the coherence over the spectral frequencies is the
enhanced envelope spectrum, over a band the improved one [3]_; they average the modulus, we its square, whose distribution
is known.

.. [1] W. A. Gardner, "Measurement of spectral correlation", *IEEE Trans. Acoust. Speech Signal Process.* 34 (1986)
       1111-1123.
.. [2] J. Antoni, "Cyclic spectral analysis in practice", *Mech. Syst. Signal Process.* 21 (2007) 597-630.
.. [3] J. Antoni, G. Xin, N. Hamzaoui, "Fast computation of the spectral correlation", *Mech. Syst. Signal Process.* 92
       (2017) 248-277.
.. [4] G. C. Carter, "Coherence and time delay estimation", *Proc. IEEE* 75 (1987) 236-255.
.. [5] J. Makhoul, "Linear prediction: a tutorial review", *Proc. IEEE* 63 (1975) 561-580.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import fft, ifft, next_fast_len, rfft
from scipy.special import gammainccinv

from features.signal.arguments import as_records, band_ends, check_positive, check_probability, like
from features.signal.demodulation import ZERO_PADDING
from features.signal.rows import ComplexArray, FloatArray, brief, by_row, squared_modulus
from features.signal.spectra import prediction_filters, sine_windowed

WINDOW_LOSS = 1.5  # coefficients per independent coefficient under a sine window
FEWEST = 20.0  # independent coefficients in a band


class Coherence(NamedTuple):
    """Spectral coherence of records.

    Attributes
    ----------
    cyclic
        Cyclic frequencies alpha from 0 [Hz], four for each resolution of the record, shape (cyclic,). At 0 and at two
        resolutions above it the coherence is near 1 for any signal.
    spectral
        Centres of the bands of the spectral frequency f [Hz], shape (spectral,). A coherence links f and f + alpha.
    squared
        Squared modulus, between 0 and 1, shape (record, spectral, cyclic).
    independent
        Number of independent coefficients in each band.
    """

    cyclic: FloatArray
    spectral: FloatArray
    squared: FloatArray
    independent: float

    def __repr__(self) -> str:
        return brief(self)

    def threshold(self, probability: float) -> float:
        """Squared modulus that one value of stationary noise exceeds with a probability."""
        check_probability(probability)
        return 1 - probability ** (1 / (self.independent - 1))

    def envelope_threshold(self, probability: float, band: tuple[float, float] | None = None) -> float:
        """Height that one bin of `enhanced_envelope_spectrum` exceeds in stationary noise with a probability."""
        check_probability(probability)
        bands = np.count_nonzero(self.inside(band))
        return float(gammainccinv(bands, probability) / (bands * self.independent))

    def inside(self, band: tuple[float, float] | None) -> np.ndarray:
        """Whether each spectral frequency lies in a band [Hz]; None for all, shape (spectral,)."""
        low, high = (0.0, np.inf) if band is None else band_ends(band)
        chosen = (self.spectral >= low) & (self.spectral <= high)
        if not chosen.any():
            raise ValueError(f"no spectral frequency lies in {low:g}-{high:g} Hz: choose a wider band.")
        return chosen


def spectral_coherence(x: ArrayLike, fs: float, highest: float, *, resolution: float = 200.0) -> Coherence:
    """Squared spectral coherence at all cyclic frequencies up to ``highest`` [Hz].

    Halfway between two cyclic frequencies of the grid, a line is 2 % lower. Tones of the machine are coherent, too:
    remove them before.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    highest
        Highest cyclic frequency [Hz]. Spectral frequencies end this much below ``fs / 2``.
    resolution
        Width of the bands of the spectral frequency [Hz]. Each has ``resolution / 1.5`` independent coefficients per
        second of the record. Impacts without slip that follow each other faster than this are predicted, and lower.
    """
    check_positive(fs=fs, highest=highest, resolution=resolution)
    records = as_records(x)
    n = records.shape[-1]
    length = next_fast_len(ZERO_PADDING * n, real=True)
    bin_width = fs / length
    width, lags = round(resolution / bin_width), int(highest / bin_width) + 1
    count = (length // 2 + 1 - lags) // max(width, 1)
    independent = width * n / (length * WINDOW_LOSS)
    if independent < FEWEST or count < 1:
        raise ValueError(
            f"bands of {resolution:g} Hz and cyclic frequencies up to {highest:g} Hz do not fit a record of {n / fs:.3g} s "
            f"at {fs:g} Hz: a band has at least {FEWEST * WINDOW_LOSS:g} cycles in the record, and ends below fs / 2."
        )
    coefficients = sine_windowed(records, length)
    coefficients *= rfft(prediction_filters(coefficients, length, round(fs / resolution)), n=length, axis=-1)
    squared = np.stack([_coherence(coefficients[:, b * width :], width, lags) for b in range(count)], axis=1)
    bands = (np.arange(count) + 0.5) * width * bin_width
    return Coherence(np.arange(lags) * bin_width, bands, like(x, squared), independent)


def _coherence(coefficients: ComplexArray, width: int, lags: int) -> FloatArray:
    """Squared coherence of the first ``width`` coefficients with those up to ``lags`` bins higher, shape (record, lag)."""
    reach = width + lags - 1
    length = next_fast_len(reach)
    upper = coefficients[:, :reach]
    transform = by_row(fft, upper, length) * np.conj(by_row(fft, upper[:, :width], length))
    product = squared_modulus(by_row(ifft, transform, length)[:, :lags])
    power = np.zeros((len(upper), reach + 1))
    np.cumsum(squared_modulus(upper), axis=-1, dtype=float, out=power[:, 1:])
    within = power[:, width:] - power[:, :lags]
    least = np.finfo(product.dtype).tiny
    return product / np.maximum(within * within[:, :1], least).astype(product.dtype)


def enhanced_envelope_spectrum(coherence: Coherence, band: tuple[float, float] | None = None) -> FloatArray:
    """Mean squared coherence over all spectral frequencies, or over those in a band [Hz], shape (record, cyclic)."""
    if not isinstance(coherence, Coherence):
        raise TypeError("coherence: give the Coherence that spectral_coherence returns.")
    return coherence.squared[..., coherence.inside(band), :].mean(axis=-2)
