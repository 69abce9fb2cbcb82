"""Contents of a corpus, each computed here alone: console, data card, report and benchmark show them.

``columns`` are variables of the format by name: an opened corpus, or arrays of shape (record,). A function takes the columns that it
names, so that ``raceway info`` reads few variables, and those without xarray.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gen.corpus.fault_classes import FAULT_NAMES, FAULTS
from gen.corpus.schema import SPLITS
from gen.corpus.simulated import UNJUDGED

COARSE = 0.05  # relative rms change of the motion; a step of the usual fineness changes a record by some thousandths
UNITS = ("rig", "specimen", "recording")
"""Variables that `unit_counts` needs: a specimen is numbered in its rig, and a recording in its specimen."""
OF_FAULTS = ("detectable", "fault_tries", "level_tries")
"""Variables of simulated corpora that `fault_counts` needs, beside ``fault``, ``rig`` and ``specimen``."""

Columns = Mapping[Any, Any]


class UnitCounts(NamedTuple):
    """Number of records, and of the recordings, specimens and rigs that they come from."""

    records: int
    recordings: int
    specimens: int
    rigs: int


class FaultCounts(NamedTuple):
    """Of a simulated corpus."""

    records: int
    """Records labelled with a fault."""
    detectable: int
    """Of these, records in which the fault can be seen."""
    unjudged: int
    """Of these, records of which it is not known."""
    redrawn_specimens: int
    """Specimens whose first fault could not be seen."""
    redrawn_levels: int
    """Records whose first level hid the fault."""


def unit_counts(columns: Columns) -> UnitCounts:
    """Counts of the records with the columns ``rig``, ``specimen`` and ``recording``.

    >>> unit_counts({"rig": [0, 0, 1], "specimen": [0, 0, 0], "recording": [0, 1, 0]})
    UnitCounts(records=3, recordings=3, specimens=2, rigs=2)
    """
    keys = [_column(columns, name) for name in UNITS]
    return UnitCounts(len(keys[0]), *(_distinct(*keys[:depth]) for depth in (3, 2, 1)))


def class_counts(fault: ArrayLike) -> dict[str, int]:
    """Number of records of each class that has some, ``unknown`` last.

    >>> class_counts([2, 0, 2])
    {'healthy': 1, 'outer': 2}
    """
    return _named_counts(fault, FAULT_NAMES)


def split_counts(split: ArrayLike) -> dict[str, int]:
    """Number of records of each split that has some."""
    return _named_counts(split, dict(enumerate(SPLITS)))


def text_counts(texts: Iterable[str]) -> dict[str, int]:
    """Number of records of each text, such as the designation of a bearing, in the order of the letters."""
    return dict(sorted(Counter(texts).items()))


def by_class(columns: Columns, names: Iterable[str]) -> dict[str, dict[str, NDArray[Any]]]:
    """Named columns of the records of each class that has some."""
    fault, chosen = _column(columns, "fault"), {name: _column(columns, name) for name in names}
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
    known = values[np.isfinite(values)]
    return (float(known.min()), float(np.median(known)), float(known.max())) if known.size else None


def units_in_several_splits(columns: Columns) -> list[str]:
    """Those of ``rig`` and ``specimen`` of which some unit has records in two splits: then scores are too good."""
    keys = [_column(columns, name) for name in UNITS[:2]]
    split = _column(columns, "split")
    return [name for name, of in zip(UNITS, (keys[:1], keys), strict=False) if _distinct(*of, split) > _distinct(*of)]


def clipped_records(columns: Columns) -> dict[str, int] | None:
    """Number of records with a clipped sample in each class that has one; None if clipped samples were not counted.

    >>> clipped_records({"fault": [0, 1, 1, 2], "clipped": [0, 3, 7, 1]}), clipped_records({"fault": [0]})
    ({'inner': 2, 'outer': 1}, None)
    """
    return class_counts(_column(columns, "fault")[_column(columns, "clipped") > 0]) if "clipped" in columns else None


def fault_counts(columns: Columns) -> FaultCounts | None:
    """Counts of the faults that can be seen in their records; None if the corpus was not simulated or has no record with a fault."""
    if not all(name in columns for name in OF_FAULTS):
        return None
    rig, specimen, detectable, fault_tries, level_tries = (
        _column(columns, name) for name in ("rig", "specimen", *OF_FAULTS)
    )
    # whether a healthy record shows a fault is no question
    detectable = detectable[_column(columns, "fault") != FAULTS.index("healthy")]
    if not detectable.size:
        return None
    return FaultCounts(
        records=detectable.size,
        detectable=int((detectable == 1).sum()),
        unjudged=int((detectable == UNJUDGED).sum()),
        redrawn_specimens=_distinct(rig[fault_tries > 0], specimen[fault_tries > 0]),
        redrawn_levels=int((level_tries > 0).sum()),
    )


def step_complaint(columns: Columns) -> str | None:
    """Sentence with the number of records that follow their step rather than the model, and the key to change; None if there are none.

    The step of some records of a simulated corpus is checked, by integrating them again at half of it, and of no imported one.
    """
    if not ("step_error" in columns and "oversampling" in columns):
        return None
    error, steps = (_column(columns, name) for name in ("step_error", "oversampling"))
    coarse = error > COARSE
    if not coarse.any():
        return None
    # a step finer than that of every coarse record helps all of them
    worst, finest = 100 * error.max(where=coarse, initial=0), steps[coarse].max()
    return (
        f"{coarse.sum():,} of the {np.isfinite(error).sum():,} records whose step was checked change by more than {100 * COARSE:g} % "
        f"(up to {worst:.0f} %) at half the step; raise recording.oversampling above {finest}."
    )


def _distinct(*keys: NDArray[Any]) -> int:
    """Number of different combinations of values in arrays of shape (record,)."""
    return np.unique(np.stack(keys), axis=1).shape[1]


def _named_counts(codes: ArrayLike, names: Mapping[int, str]) -> dict[str, int]:
    found = np.asarray(codes)
    return {name: n for code, name in names.items() if (n := int((found == code).sum()))}


def _column(columns: Columns, name: str) -> NDArray[Any]:
    """Values of a variable, shape (record,), also of one record alone."""
    return np.atleast_1d(np.asarray(columns[name]))
