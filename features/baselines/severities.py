"""Fault widths that a test contains and its training does not.

A score on such widths measures how well a classifier extrapolates, and a reader of the score must know that. The
training of a class covers intervals of width. If its specimens share a few widths, as specimens with machined faults
do, each width is an interval of its own; else there is one interval from the smallest to the largest width.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from features.baselines.records import FloatArray, IntArray, Records
from gen.corpus import FAULTS
from gen.support.units import from_si

Intervals = tuple[tuple[float, float], ...]

Covered = dict[str, Intervals]
"""Intervals of fault width [m] by class; a class whose widths are all unknown or zero is absent."""

Widths = dict[str, tuple[float, ...]]
"""Fault widths [m] by class, ascending; a class without any is absent."""

SAME_WIDTH = 1.05  # ratio of two widths up to which they are one of the shared widths
NEAR_RANGE = 1.25  # ratio up to which a width beyond the smallest or the largest one is covered
ALL = slice(None)


def covered_widths(records: Records, rows: IntArray | slice = ALL) -> Covered:
    """Intervals of fault width that some rows cover, by class."""
    return {name: _intervals(*widths) for name, widths in _widths_by_class(records, rows).items()}


def uncovered_widths(covered: Mapping[str, Intervals], tested: Records, rows: IntArray | slice = ALL) -> Widths:
    """Widths of some tested rows that lie outside the intervals of their class.

    A class without intervals is omitted: its training widths are unknown, or it was not in the training at all.
    """
    return {
        name: outside
        for name, (widths, _) in _widths_by_class(tested, rows).items()
        if name in covered and (outside := _outside(covered[name], widths))
    }


def uncovered_in_splits(records: Records, splits: Iterable[tuple[IntArray, IntArray]]) -> Widths:
    """Widths that at least one split tests and does not train."""
    uncovered: dict[str, set[float]] = {}
    for train, test in splits:
        for name, widths in uncovered_widths(covered_widths(records, train), records, test).items():
            uncovered.setdefault(name, set()).update(widths)
    return {name: tuple(sorted(uncovered[name])) for name in FAULTS if name in uncovered}


def severity_warning(uncovered: Mapping[str, tuple[float, ...]]) -> str:
    """Sentence about widths that are tested and not trained.

    >>> severity_warning({"inner": (0.0014,), "outer": (0.0003, 0.0005)})
    'tested but not trained: inner 1.4 mm wide, outer 0.3 to 0.5 mm wide; the scores of these classes include extrapolation.'
    """
    told = ", ".join(f"{name} {_span(widths)} mm wide" for name, widths in uncovered.items())
    return f"tested but not trained: {told}; the scores of these classes include extrapolation."


def _span(widths: tuple[float, ...]) -> str:
    ends = dict.fromkeys(f"{from_si(width, 'mm'):.3g}" for width in (widths[0], widths[-1]))
    return " to ".join(ends)


def _widths_by_class(records: Records, rows: IntArray | slice) -> dict[str, tuple[FloatArray, int]]:
    """Distinct widths of each class, ascending, and the number of its distinct pairs of specimen and width."""
    fault, specimen, width = records.fault[rows], records.specimen[rows], records.width[rows]
    by_class: dict[str, tuple[FloatArray, int]] = {}
    for code in np.unique(fault):
        chosen = (fault == code) & (width > 0)
        if chosen.any():
            pairs = np.unique(np.stack([specimen[chosen], width[chosen]]), axis=1)
            by_class[FAULTS[code]] = np.unique(pairs[1]), pairs.shape[1]
    return by_class


def _intervals(widths: FloatArray, pairs: int) -> Intervals:
    if 2 * len(widths) <= pairs:
        return tuple((float(width) / SAME_WIDTH, float(width) * SAME_WIDTH) for width in widths)
    return ((float(widths[0]) / NEAR_RANGE, float(widths[-1]) * NEAR_RANGE),)


def _outside(intervals: Intervals, widths: FloatArray) -> tuple[float, ...]:
    low, high = np.transpose(intervals)
    inside = (widths[:, None] >= low) & (widths[:, None] <= high)
    return tuple(float(width) for width in widths[~inside.any(axis=1)])
