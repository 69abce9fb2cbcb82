"""How far the colour of a record is from that of healthy recordings of its machine.

``changes of band energies from the reference -> distance in scatters of healthy recordings -> not answered healthy``

Healthy recordings of one machine at about the same speed differ in colour by 1 to 3 dB, and faults change it by 3 to 15 dB, also those that
show no line (``python -m benchmarks.colour REAL``). A bent shaft, imbalance and another speed change it as much. So a record in a
strange colour is not answered healthy, and its probabilities stay.
Bands below 200 Hz do not count: the lines of the shaft lie there, and balance and speed change them in healthy machines too.
"""

from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray, IntArray, group_means
from features.table.indicators import feature_names

ENERGIES = tuple(name for name in feature_names(("bands",)) if name.endswith("_Hz"))
COUNTED = tuple(name for name in ENERGIES if int(name.split("_")[1].split("-")[0]) >= 200)
SCATTER = 3.0  # dB, of healthy recordings of a machine, unless those of the reference differ by more
DECIBELS = 10 / np.log(10)  # of a natural logarithm of energy


class Colour(NamedTuple):
    """Change of some records from their references.

    Attributes
    ----------
    changes
        Of the logarithm of the energies of ``COUNTED``, shape (channel, record, band).
    scatter
        Distance by which healthy recordings of the reference differ, shape (channel, record) [dB].
    """

    changes: FloatArray
    scatter: FloatArray

    def distances(self, numbers: IntArray) -> FloatArray:
        """Distance of the mean change of the records with each number, from 0 and without a gap, in scatters.

        It is the largest of all channels, shape (number,), and 0 without energies.
        """
        means = np.stack([group_means(channel, numbers) for channel in self.changes])
        _, first = np.unique(numbers, return_index=True)
        return np.nan_to_num(np.fmax.reduce(distance(means) / self.scatter[:, first], axis=0))


def distance(changes: FloatArray) -> FloatArray:
    """Root mean square over the bands without what all have in common, shape (..., band) to (...) [dB]."""
    shifted = changes - np.median(changes, axis=-1, keepdims=True)
    return DECIBELS * np.sqrt(np.mean(shifted**2, axis=-1))


def scatter_of(energies: FloatArray) -> float:
    """Distance by which recordings of a reference differ [dB]: the largest of one from the mean of the others, at least ``SCATTER``.

    ``energies`` are those of ``COUNTED``, shape (recording, band).
    """
    if len(energies) < 2:
        return SCATTER
    others = (energies.sum(axis=0) - energies) / (len(energies) - 1)
    return max(SCATTER, float(distance(energies - others).max()))
