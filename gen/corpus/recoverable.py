"""Which labels of a corpus can be recovered from its signals? Rank correlations with simple numbers of the records.

A label that neither the level nor the impulsiveness nor the colour of a record follows can hardly be learned from it. Records of one
specimen share its fault, so a label of the specimen is compared with the mean over its records.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.schema import FAULTS, SIGNAL

FloatArray = NDArray[np.float64]

MOST_RECORDS = 1500  # drawn at random from a larger corpus; more change the correlations by some hundredths
_BLOCK = 64  # records read at a time
FEWEST = 20  # specimens or records of a class
LABELS = ("width", "depth", "largest_drop", "n_spalls", "diametral_clearance", "load", "shaft_rate", "fault_snr")
NUMBERS = ("rms", "kurtosis", "crest factor", "power above a quarter of the sample rate")


class Recovery(NamedTuple):
    """How closely a number of the records follows a label within one class."""

    label: str
    fault: str
    number: str
    """Of :data:`NUMBERS`, the one that follows the label most closely."""
    correlation: float
    """Spearman's rank correlation [1]."""
    items: int
    """Of the specimens, or of the records for a label that changes from record to record."""


def recoveries(corpus: xr.Dataset) -> list[Recovery]:
    """Closest number for each label and each class of fault; labels that do not vary are left out."""
    n_records = corpus.sizes["record"]
    # every so many records would be the same rung of every ladder, or the same record of every specimen
    drawn = np.random.default_rng(0).choice(n_records, min(MOST_RECORDS, n_records), replace=False)
    some = corpus.isel(record=np.sort(drawn))
    numbers = record_numbers(some)
    closest = []
    for code, fault in enumerate(FAULTS):
        rows = np.flatnonzero(some["fault"].values == code)
        for label in (name for name in LABELS if name in some and fault != "healthy"):
            values, of_rows = some[label].values[rows].astype(float), numbers[rows]
            known = np.isfinite(values)
            values, of_rows = _of_specimens(values[known], of_rows[known], some["specimen"].values[rows][known])
            if len(values) < FEWEST or np.ptp(values) == 0:
                continue
            correlations = [rank_correlation(values, column) for column in of_rows.T]
            best = int(np.argmax(np.abs(correlations)))
            closest.append(Recovery(label, fault, NUMBERS[best], correlations[best], len(values)))
    return closest


def record_numbers(corpus: xr.Dataset) -> FloatArray:
    """The ``NUMBERS`` of each record, of its first channel, shape (record, number)."""
    numbers = np.zeros((corpus.sizes["record"], len(NUMBERS)))
    for first in range(0, len(numbers), _BLOCK):
        block = slice(first, first + _BLOCK)
        signals = corpus[SIGNAL][block, 0].values.astype(float)
        signals -= signals.mean(axis=1, keepdims=True)
        power = np.abs(np.fft.rfft(signals)) ** 2
        squares = np.square(signals, out=signals)
        rms, peak = np.sqrt(squares.mean(axis=1)), np.sqrt(squares.max(axis=1))
        kurtosis = np.square(squares).mean(axis=1)
        above, of_all = power[:, power.shape[1] // 2 :].sum(axis=1), power.sum(axis=1)
        level, total = np.where(rms > 0, rms, 1.0), np.where(of_all > 0, of_all, 1.0)  # a dead record has only zeros
        numbers[block] = np.stack([rms, kurtosis / level**4, peak / level, above / total], axis=1)
    return numbers


def _of_specimens(
    values: FloatArray, numbers: FloatArray, specimens: NDArray[np.int_]
) -> tuple[FloatArray, FloatArray]:
    """Values and mean numbers of the specimens, if all records of a specimen have the same value; else those of the records."""
    every, place = np.unique(specimens, return_inverse=True)
    first = np.zeros(len(every))
    first[place] = values
    if len(every) == len(values) or not np.array_equal(first[place], values):
        return values, numbers
    sums = np.zeros((len(every), numbers.shape[1]))
    np.add.at(sums, place, numbers)
    return first, sums / np.bincount(place)[:, None]


def rank_correlation(x: FloatArray, y: FloatArray) -> float:
    """Spearman's rank correlation [1]; tied values share their mean rank. 0 if one of them is constant.

    >>> round(rank_correlation(np.array([1.0, 2, 3, 4]), np.array([1.0, 4, 9, 100])), 12)
    1.0
    """
    a, b = (_ranks(values) for values in (x, y))
    spread = np.std(a) * np.std(b)
    return float(np.mean((a - a.mean()) * (b - b.mean())) / spread) if spread > 0 else 0.0


def _ranks(values: FloatArray) -> FloatArray:
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(counts) - (counts - 1) / 2)[place]
