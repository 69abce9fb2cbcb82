"""Counts of the records, units and classes of a corpus.

``columns`` are variables of the format by name: an opened corpus, or arrays of shape (record,).
"""

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gen.corpus.fault_classes import FAULT_NAMES

UNITS = ("rig", "specimen", "recording")
"""Variables that `unit_counts` needs: a specimen is numbered in its rig, and a recording in its specimen."""
Columns = Mapping[Any, Any]


class UnitCounts(NamedTuple):
    """Number of records, and of the recordings, specimens and rigs that they come from."""

    records: int
    recordings: int
    specimens: int
    rigs: int


def unit_counts(columns: Columns) -> UnitCounts:
    """Counts of the records with the columns ``rig``, ``specimen`` and ``recording``.

    >>> unit_counts({"rig": [0, 0, 1], "specimen": [0, 0, 0], "recording": [0, 1, 0]})
    UnitCounts(records=3, recordings=3, specimens=2, rigs=2)
    """
    keys = [column(columns, name) for name in UNITS]
    return UnitCounts(len(keys[0]), *(distinct(*keys[:depth]) for depth in (3, 2, 1)))


def class_counts(fault: ArrayLike) -> dict[str, int]:
    """Number of records of each class that has some, ``unknown`` last.

    >>> class_counts([2, 0, 2])
    {'healthy': 1, 'outer': 2}
    """
    codes = np.asarray(fault)
    return {name: n for code, name in FAULT_NAMES.items() if (n := int((codes == code).sum()))}


def by_class(columns: Columns, names: Iterable[str]) -> dict[str, dict[str, NDArray[Any]]]:
    """Named columns of the records of each class that has some."""
    fault, chosen = column(columns, "fault"), {name: column(columns, name) for name in names}
    return {
        name: {key: values[fault == code] for key, values in chosen.items()}
        for code, name in FAULT_NAMES.items()
        if (fault == code).any()
    }


def extent(values: NDArray[Any]) -> tuple[float, float, float] | None:
    """Least, median and largest finite value; None if there are none.

    >>> extent(np.array([2.0, np.nan, 4.0]))
    (2.0, 3.0, 4.0)
    """
    finite = values[np.isfinite(values)]
    return (float(finite.min()), float(np.median(finite)), float(finite.max())) if finite.size else None


def numbered(*keys: NDArray[Any]) -> NDArray[np.intp]:
    """Number from 0 of each different combination of values in arrays of shape (record,).

    >>> numbered(np.array([7, 7, 8]), np.array([1, 1, 1]))
    array([0, 0, 1])
    """
    return np.unique(np.stack(keys), axis=1, return_inverse=True)[1].reshape(-1)


def specimen_numbers(columns: Columns) -> NDArray[np.intp]:
    """Number from 0 of the specimen of each record, shape (record,): that of the format begins again in each rig."""
    return numbered(*(column(columns, name) for name in UNITS[:2]))


def distinct(*keys: NDArray[Any]) -> int:
    """Number of different combinations of values in arrays of shape (record,)."""
    return np.unique(np.stack(keys), axis=1).shape[1]


def column(columns: Columns, name: str) -> NDArray[Any]:
    """Values of a variable, shape (record,), also of one record alone."""
    return np.atleast_1d(np.asarray(columns[name]))
