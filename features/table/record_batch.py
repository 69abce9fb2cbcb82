"""A batch of records, and what feature groups read of it: whitened bands, and the spectra of their envelopes.

``records -> six whitened analytic signals -> level of their envelope spectra over the floor, and shape of their envelopes``

The six signals are a broad band (`features.table.band`, 0.3-5 kHz by default) with cepstral pre-whitening, the same band
divided by its power spectral density, and four narrower bands of the latter; another band has its own narrower ones.
Frequencies above the band are not used, so that features depend as little as possible on the recording equipment.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from features.signal.demodulation import ZERO_PADDING, analytic_band, spectrum_over_floor
from features.signal.lines import Orders, highest_order
from features.signal.rows import ComplexArray, FloatArray, IntArray, squared_modulus
from features.signal.shape import envelope_shape
from features.signal.spectra import fourier_coefficients, whiten_by_psd, whiten_cepstrally
from features.table.band import DEFAULT_BAND, Band

WHITENING_WIDTH = 50.0  # Hz
FLOOR_WIDTH = (3.0, 30.0)  # window of the floor: orders of the shaft, and its least width [Hz]

SHORTEST = (2.0, 0.05)  # shaft revolutions and seconds below which a record shows no line
LOWEST_RATE = DEFAULT_BAND.lowest_rate  # Hz

BATCH = 16  # records computed together, so that their arrays fit into the cache of a core; features do not depend on it


class Envelopes(NamedTuple):
    """Envelopes of the whitened bands of some records."""

    orders: Orders
    """Nominal orders of the records."""
    coefficients: ComplexArray
    """Fourier coefficients of the signals up to the end of the band, shape (record, frequency)."""
    level: FloatArray
    """Levels as of `features.signal.demodulation.log_level`, shape (record, band, bin)."""
    shape: FloatArray
    """Values of `features.signal.shape.envelope_shape`, shape (record, band, value)."""
    bins_per_order: FloatArray
    """Bins of a level per order of the shaft, shape (record,)."""


@dataclass(frozen=True, eq=False)
class RecordBatch:
    """Some records whose features are computed together, none of which may depend on the others.

    Attributes
    ----------
    x
        Signals without their mean, shape (record, time).
    fs
        Sample rate [Hz].
    shaft_rate
        Shape (record,) [Hz].
    orders
        Nominal orders ``ftf, bpfo, bpfi, bsf``, each of shape (record,).
    band
        Band of frequencies that features are computed from.
    """

    x: FloatArray
    fs: float
    shaft_rate: FloatArray
    orders: Orders
    band: Band = DEFAULT_BAND

    @cached_property
    def with_lines(self) -> IntArray:
        """Numbers of the records that can show lines: neither too short nor sampled too slowly for the band."""
        duration = self.x.shape[-1] / self.fs
        readable = self.fs >= self.band.lowest_rate and duration >= SHORTEST[1]
        return np.flatnonzero(readable & (duration * self.shaft_rate >= SHORTEST[0]))

    @cached_property
    def envelopes(self) -> Envelopes:
        """Envelopes of the records of `with_lines`, computed once for all groups of features."""
        rows, duration = self.with_lines, self.x.shape[-1] / self.fs
        orders = Orders(*(order[rows] for order in self.orders))
        # one transform of the signal serves all bands
        coefficients = fourier_coefficients(self.x[rows], self.fs, self.band.high)
        bands = bands_of(coefficients, duration, self.fs, self.band)
        read = levels_and_shape(bands, duration, self.shaft_rate[rows], highest_order(orders))
        return Envelopes(orders, coefficients, *read)


def usable_records(x: FloatArray, shaft_rate: FloatArray, orders: Orders) -> np.ndarray:
    """Whether each signal varies and is finite, and its shaft rate and orders are positive numbers, shape (record,)."""
    positive = [np.isfinite(values) & (values > 0) for values in (shaft_rate, *orders)]
    highest, lowest = x.max(axis=-1), x.min(axis=-1)
    return np.isfinite(highest) & np.isfinite(lowest) & (highest > lowest) & np.logical_and.reduce(positive)


def bands_of(coefficients: ComplexArray, duration: float, fs: float, band: Band = DEFAULT_BAND) -> list[ComplexArray]:
    """Both broad bands of whitened coefficients, and the narrow bands with more than half below the Nyquist frequency."""
    cepstral = whiten_cepstrally(coefficients)
    whitened = whiten_by_psd(coefficients, round(WHITENING_WIDTH * duration))
    narrow = [(whitened, edges) for edges in band.narrow if sum(edges) < fs]
    cuts = [(cepstral, band), (whitened, band), *narrow]
    return [source[:, round(low * duration) : round(high * duration)] for source, (low, high) in cuts]


def levels_and_shape(
    bands: list[ComplexArray], duration: float, shaft_rate: FloatArray, highest: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Envelope spectrum of each band over its floor, and the shape of its envelope.

    Parameters
    ----------
    bands
        Coefficients of each band, as from `bands_of`.
    duration
        Of the records [s].
    shaft_rate
        Shape (record,) [Hz].
    highest
        Order up to which levels are needed, shape (record,).

    Returns
    -------
    Levels as of `log_level`, shape (record, band, bin), 0 beyond the end of a spectrum; values of `envelope_shape`, shape
    (record, band, value); and bins per order, shape (record,).
    """
    resolution = 1 / (ZERO_PADDING * duration)
    bins = int(np.max(highest * shaft_rate) / resolution) + 2
    # the floor spans some lines of the shaft, and at least a width that noise needs
    width = np.maximum(FLOOR_WIDTH[0] * shaft_rate, FLOOR_WIDTH[1]) / resolution
    level = np.zeros((len(shaft_rate), len(bands), bins), np.float32)
    shape = list[FloatArray]()
    for number, band in enumerate(bands):
        z = analytic_band(band, 0, band.shape[-1])
        power = squared_modulus(z)
        weighted, spectrum, over_floor = spectrum_over_floor(np.sqrt(power), width, bins)
        level[:, number, : over_floor.shape[1]] = over_floor
        shape.append(envelope_shape(power, weighted, spectrum, z.shape[-1] / duration, shaft_rate))
    return level, np.stack(shape, axis=1), shaft_rate / resolution
