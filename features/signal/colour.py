"""Colour of a power spectrum: where its energy lies, and how much of it lies in narrow lines.

None of these depends on gain. Roll-off and centroid are those of sound analysis [1]_, with energies in place of moduli.

.. [1] G. Peeters, "A large set of audio features for sound description (similarity and classification) in the CUIDADO
       project", IRCAM, Paris, 2004.
"""

import numpy as np

from features.signal.demodulation import running_median
from features.signal.rows import FloatArray

MEDIAN_WIDTH = 100.0  # Hz, window of the median that a narrow line is compared with
NARROW_LINE = 10.0  # times that median: one bin in a thousand of Gaussian noise is as high


def roll_off(density: FloatArray, frequencies: FloatArray, share: float) -> FloatArray:
    """Frequency below which a share of the energy lies [Hz], shape (record,).

    Parameters
    ----------
    density
        Power spectral density, shape (record, frequency), not all zero.
    frequencies
        Shape (frequency,) [Hz], equally spaced.
    share
        Between 0 and 1.
    """
    energy = np.cumsum(density, axis=-1, dtype=float)
    upper = frequencies + 0.5 * (frequencies[1] - frequencies[0])
    return np.array([np.interp(share * row[-1], row, upper) for row in energy])


def centroid(density: FloatArray, frequencies: FloatArray) -> FloatArray:
    """Mean frequency weighted with the energy [Hz], shape (record,)."""
    return (density * frequencies).sum(axis=-1) / density.sum(
        axis=-1
    )  # a product of matrices rounds by the number of rows


def tonality(density: FloatArray, frequencies: FloatArray) -> FloatArray:
    """Share of the energy in bins that are ten times as high as the median of the 100 Hz around them, shape (record,).

    Parameters
    ----------
    density
        Power spectral density at the full resolution of the record (one segment), shape (record, frequency).
    frequencies
        Shape (frequency,) [Hz], equally spaced.
    """
    width = np.full(len(density), MEDIAN_WIDTH / (frequencies[1] - frequencies[0]))
    floor = running_median(density, width, density.shape[-1])
    return np.where(density > NARROW_LINE * floor, density, 0.0).sum(axis=-1) / density.sum(axis=-1)
