"""Averaged envelope spectra of one recording in several bands, and the level that noise exceeds with a given probability.

``recording -> overlapping segments -> whitened band -> envelope spectrum -> mean power over its floor``

In noise without periods, each bin of an envelope spectrum is distributed as a chi-square with two degrees of freedom, so
the mean of K segments over its expectation is a gamma variable of shape K [1]_. Segments under a Hann window that
overlap by half count as K / 1.056 independent ones [2]_. The expectation is taken from a running median.

.. [1] J. S. Bendat, A. G. Piersol, *Random Data*, 4th ed., Wiley, 2010, chapter 8.
.. [2] F. J. Harris, "On the use of windows for harmonic analysis with the discrete Fourier transform", *Proc. IEEE* 66
       (1978) 51-83.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import gammainccinv, gammaincinv

from features.signal.demodulation import analytic_band, envelope_spectrum, running_median
from features.signal.impulsive import band_kurtosis, equal_bands
from features.signal.rows import FloatArray
from features.signal.spectra import fourier_coefficients, whiten_by_psd
from features.table.band import DEFAULT_BAND
from features.table.record_batch import WHITENING_WIDTH

SEGMENT_TURNS = (20, 40)  # least and most shaft revolutions of a segment; 40 resolve a twentieth of an order
SEGMENT_SECONDS = 0.5  # its least length [s]
OVERLAP_LOSS = 1.056  # segments per independent segment, Hann window and half overlap [2]
FLOOR_ORDERS, FLOOR_HZ = 6.0, 60.0  # window of the floor: orders of the shaft, and its least width [Hz]
NEAR_ORDERS, NEAR_BINS = 0.6, 12.0  # window of a second floor, which follows a slope: orders, and independent bins
TOP_ORDER = 20.0  # highest order of the spectra
KURTOSIS_LEVELS = (2, 3, 4, 6, 8, 12, 16)  # equal divisions of the spectrum in which an impulsive band is searched
NARROWEST = 600.0  # Hz, of an impulsive band: a line and three harmonics must fit


class BandSpectrum(NamedTuple):
    """Mean envelope spectrum of one band.

    Attributes
    ----------
    band
        Lower and upper edge [Hz].
    resolution
        Distance of two bins [Hz]; bin 0 is at 0 Hz.
    width
        Half the width of the main lobe of a line [Hz].
    ratio
        Mean power over the power expected in noise, shape (frequency,).
    segments
        Number of independent segments.
    channel
        Of the recording.
    """

    band: tuple[float, float]
    resolution: float
    width: float
    ratio: FloatArray
    segments: float
    channel: str = ""

    def threshold(self, probability: float) -> float:
        """Ratio that a bin of noise exceeds with a probability."""
        return float(gammainccinv(self.segments, probability) / self.segments)

    def bins(self, frequency: float, tolerance: float) -> tuple[int, int]:
        """First bin within a tolerance [Hz] of a frequency [Hz], and the bin after the last; empty beyond the spectrum."""
        first = max(0, int(np.ceil((frequency - tolerance) / self.resolution)))
        return first, max(first, min(int((frequency + tolerance) / self.resolution) + 1, len(self.ratio)))


def band_spectra(
    x: FloatArray, fs: float, shaft_rate: float, channel: str = "", bands: Sequence[tuple[float, float]] | None = None
) -> list[BandSpectrum]:
    """Envelope spectra of a channel, shape (time,), in some bands [Hz], by default those of `bands_of`.

    They end at 20 orders or at the width of the band.
    """
    segments, duration = _segments(x, fs, shaft_rate)
    coefficients = fourier_coefficients(segments, fs, fs / 2)
    # resonances and tones would otherwise rule the envelope
    whitened = whiten_by_psd(coefficients, round(WHITENING_WIDTH * duration))
    # overlapping segments are worth less than independent ones
    count = 1 + (len(segments) - 1) / OVERLAP_LOSS
    spectra = []
    for band in bands_of(x, fs) if bands is None else bands:
        low, high = (round(edge * duration) for edge in band)
        z = analytic_band(whitened, low, min(high, whitened.shape[-1]))
        frequencies, amplitude = envelope_spectrum(z, z.shape[-1] / duration)
        resolution = float(frequencies[1])
        top = min(TOP_ORDER * shaft_rate, 0.6 * (band[1] - band[0]))
        bins = min(int(top / resolution) + 1, amplitude.shape[-1])
        power = np.mean(amplitude.astype(float) ** 2, axis=0)
        # over the floor, so that one bound of noise holds at all frequencies
        ratio = power[:bins] / _floor(power, resolution, shaft_rate, count, bins)
        spectra.append(BandSpectrum(band, resolution, 2 / duration, ratio, count, channel))
    return spectra


def bands_of(x: FloatArray, fs: float) -> list[tuple[float, float]]:
    """Bands [Hz] in which lines are searched: the broad one, those of the features, and the most impulsive one."""
    top = fs / 2
    bands = [(DEFAULT_BAND.low, min(DEFAULT_BAND.high, top)), *(band for band in DEFAULT_BAND.narrow if sum(band) < fs)]
    piece = x[: round(min(len(x), 4 * fs))]
    coefficients = whiten_by_psd(fourier_coefficients(piece[None], fs, top), round(WHITENING_WIDTH * len(piece) / fs))
    levels = tuple(level for level in KURTOSIS_LEVELS if top / level >= NARROWEST) or (1,)
    cuts = equal_bands(coefficients.shape[-1], levels)
    low, high = cuts[np.argmax(band_kurtosis(coefficients, cuts)[0])] * fs / len(piece)
    return [*bands, (float(max(low, 1.0)), float(min(high, top)))]


def _segments(x: FloatArray, fs: float, shaft_rate: float) -> tuple[FloatArray, float]:
    """Segments that overlap by half, shape (segment, time), and their length [s]."""
    turns = np.clip(0.5 * len(x) / fs * shaft_rate, *SEGMENT_TURNS)  # two segments or more, if they are long enough
    length = min(len(x), round(fs * max(SEGMENT_SECONDS, turns / shaft_rate)))
    starts = np.arange(0, len(x) - length + 1, max(1, length // 2))
    return np.stack([x[start : start + length] for start in starts]).astype(np.float32), length / fs


def _floor(power: FloatArray, resolution: float, shaft_rate: float, count: float, bins: int) -> FloatArray:
    """Power expected in noise: the higher of a running median over a wide window and over a near one, shape (frequency,)."""
    independent = 4 * resolution  # the grid of `envelope_spectrum` is four times finer
    wide = max(FLOOR_ORDERS * shaft_rate, FLOOR_HZ)
    near = max(NEAR_ORDERS * shaft_rate, NEAR_BINS * independent)
    row = power[None]
    medians = [running_median(row, np.array([width / resolution]), bins)[0] for width in (wide, near)]
    middle = gammaincinv(count, 0.5) / count  # median over mean
    return np.maximum(np.maximum(*medians) / middle, np.finfo(float).tiny)
