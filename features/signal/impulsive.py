"""Bands in which a signal is impulsive: kurtogram, and the band in which a fault line stands out.

The kurtogram divides the spectrum into 1, 2, 3, 4, 6, 8, 12, ... equal bands, the tree of [1]_. One Fourier transform of the
record gives the analytic signals of all bands, in place of a cascade of filters. A fault line need not lie where the
kurtosis is highest, so that `comb_bands` takes the level of its harmonics in the squared envelope spectrum, as the
protrugram does [2]_.

.. [1] J. Antoni, "Fast computation of the kurtogram for the detection of transient faults", *Mech. Syst. Signal
       Process.* 21 (2007) 108-124.
.. [2] T. Barszcz, A. Jablonski, "A novel method for the optimal band selection for vibration signal demodulation and
       comparison with the Kurtogram", *Mech. Syst. Signal Process.* 25 (2011) 431-451.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from features.signal.arguments import as_records, check_finite, check_positive, like, of_each
from features.signal.demodulation import ZERO_PADDING, analytic_band, spectrum_over_floor
from features.signal.lines import COMB_HARMONICS, combs
from features.signal.rows import ComplexArray, FloatArray, IntArray, brief, squared_modulus
from features.signal.spectra import fourier_coefficients

FEWEST = 200  # independent complex samples of the narrowest bands: the kurtosis of noise then errs by 0.14 (rms)
OVERLAP = 0.25  # share of its width by which a band extends beyond each edge; without, 15 of 100 resonances at -12 dB are missed
COMB_WIDTH = 4.0  # fault rates in the narrowest band of `comb_bands`: the third harmonic keeps a quarter of its height
FLOOR_RATES = 2.0  # fault rates in the window of the floor of an envelope spectrum


class BandTree(NamedTuple):
    """Score of each band of a kurtogram.

    Attributes
    ----------
    levels
        Number of equal bands that the band is one of, shape (band,).
    edges
        Lower and upper edge of each band [Hz], shape (band, 2).
    score
        Shape (record, band).
    quantity
        What the score is, with its unit.
    """

    levels: IntArray
    edges: FloatArray
    score: FloatArray
    quantity: str

    def __repr__(self) -> str:
        low, high = np.atleast_2d(self.best())[0]
        first = " of the first record" if self.score.ndim > 1 else ""
        return f"{brief(self)}, best band{first} {low:.0f} to {high:.0f} Hz"

    def best(self) -> FloatArray:
        """Edges of the band of highest score of each record [Hz], shape (record, 2)."""
        return self.edges[np.argmax(self.score, axis=-1)]


def kurtogram(x: ArrayLike, fs: float, *, narrowest: float = 0.0) -> BandTree:
    """Kurtosis ``E|z|^4 / (E|z|^2)^2 - 2`` of the analytic signal z of each band: 0 for noise, -1 for a tone, above for impulses.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    narrowest
        Least width of a band [Hz]. A band has at least 200 independent samples in any case.
    """
    check_positive(fs=fs)
    check_finite(narrowest=narrowest)
    records = as_records(x)
    coefficients = fourier_coefficients(records, fs, fs / 2)
    levels, bands, edges = _tree(coefficients, fs / records.shape[-1], narrowest)
    return BandTree(levels, edges, like(x, band_kurtosis(coefficients, bands, OVERLAP)), "kurtosis")


def comb_bands(x: ArrayLike, fs: float, rate: ArrayLike) -> BandTree:
    """Level of a fault line and two harmonics over the floor of the squared envelope spectrum of each band [nepers].

    The bands are those of `kurtogram` with a width of at least four fault rates; narrower ones have the score ``-inf``.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    rate
        Rate of the fault [Hz], shape (record,), right within 2 %.
    """
    check_positive(fs=fs)
    records = as_records(x)
    rates, duration = of_each(rate, "rate", records), records.shape[-1] / fs
    coefficients = fourier_coefficients(records, fs, fs / 2)
    levels, bands, edges = _tree(coefficients, 1 / duration, COMB_WIDTH * float(rates.min()))
    score = np.stack([_comb_level(analytic_band(coefficients, *band), duration, rates) for band in bands], axis=-1)
    too_narrow = COMB_WIDTH * rates[:, None] > np.diff(edges).T
    return BandTree(levels, edges, like(x, np.where(too_narrow, -np.inf, score)), "level of the fault line [nepers]")


def _comb_level(z: ComplexArray, duration: float, rate: FloatArray) -> FloatArray:
    """Comb of each record in the squared envelope spectrum of its analytic signal, shape (record,)."""
    place = rate * duration * ZERO_PADDING
    bins = int((COMB_HARMONICS + 1) * place.max())
    _, _, level = spectrum_over_floor(squared_modulus(z), FLOOR_RATES * place, bins)
    return combs(level, place[:, None])[:, 0]


def _tree(coefficients: ComplexArray, resolution: float, narrowest: float) -> tuple[IntArray, IntArray, FloatArray]:
    """Levels, first and last bins and edges [Hz] of the bands of the tree that are wide enough."""
    bins = coefficients.shape[-1]
    most = int(bins / max(FEWEST, narrowest / resolution))
    if most < 1:
        raise ValueError(
            f"records of {1 / resolution:.3g} s have no band of {FEWEST} samples that is {narrowest:.6g} Hz wide: take "
            "longer records or a lower width."
        )
    numbers = sorted(
        {first << shift for first in (1, 3) for shift in range(most.bit_length()) if first << shift <= most}
    )
    bands = equal_bands(bins, numbers)
    edges = np.concatenate([np.arange(n)[:, None] + [0, 1] for n in numbers]) / np.repeat(numbers, numbers)[:, None]
    return np.repeat(numbers, numbers), bands, edges * (bins - 1) * resolution


def equal_bands(bins: int, levels: ArrayLike) -> IntArray:
    """First bin of each band, and the bin after its last, of spectra divided into each number of bands, shape (band, 2)."""
    cuts = [np.linspace(0, bins, level + 1).round().astype(int) for level in np.atleast_1d(levels)]
    return np.concatenate([np.stack([edges[:-1], edges[1:]], axis=-1) for edges in cuts])


def band_kurtosis(coefficients: ComplexArray, bands: IntArray, overlap: float = 0.0) -> FloatArray:
    """Kurtosis ``E|z|^4 / (E|z|^2)^2 - 2`` of the analytic signal z of each band, shape (record, band).

    Parameters
    ----------
    coefficients
        Shape (record, frequency), as from `features.signal.spectra.fourier_coefficients`, whitened or not.
    bands
        As of `equal_bands`, shape (band, 2).
    overlap
        Share of its width by which a band extends beyond each edge, under a sine that is 3 dB down at the edge.
    """
    cuts = (_cut(coefficients, low, high, int(overlap * (high - low))) for low, high in bands.tolist())
    return np.stack([_kurtosis(analytic_band(cut, 0, cut.shape[-1])) for cut in cuts], axis=-1)


def _cut(coefficients: ComplexArray, low: int, high: int, reach: int) -> ComplexArray:
    """Coefficients of a band that rises over ``2 * reach`` bins at its lower edge, and falls likewise."""
    first, last = max(low - reach, 0), min(high + reach, coefficients.shape[-1])
    if reach == 0:
        return coefficients[:, first:last]
    place = np.arange(first, last) + 0.5
    beyond = np.clip(np.maximum(low - place, place - high) / reach, -1, 1)
    return coefficients[:, first:last] * np.cos(0.25 * np.pi * (1 + beyond)).astype(coefficients.real.dtype)


def _kurtosis(z: ComplexArray) -> FloatArray:
    power = squared_modulus(z).astype(float)
    mean = np.maximum(power.mean(axis=-1), np.finfo(float).tiny)
    return np.mean((power / mean[:, None]) ** 2, axis=-1) - 2.0
