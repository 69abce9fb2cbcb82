"""Further counts of a corpus: what ``raceway info``, data cards and reports tell beside those that features need."""

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gen.corpus.contents import UNITS, Columns, class_counts, column, distinct
from gen.corpus.fault_classes import FAULTS
from gen.corpus.schema import SPLITS
from gen.corpus.simulated import UNJUDGED

COARSE = 0.05  # relative rms change of the motion; a step of the usual fineness changes a record by some thousandths
OF_FAULTS = ("detectable", "fault_tries", "level_tries")
"""Variables of simulated corpora that `fault_counts` needs, beside ``fault``, ``rig`` and ``specimen``."""


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


def split_counts(split: ArrayLike) -> dict[str, int]:
    """Number of records of each split that has some."""
    counts = Counter(np.asarray(split).tolist())
    return {name: counts[code] for code, name in enumerate(SPLITS) if counts[code]}


def text_counts(texts: Iterable[str]) -> dict[str, int]:
    """Number of records of each text, such as the designation of a bearing, in the order of the letters."""
    return dict(sorted(Counter(texts).items()))


def units_in_several_splits(columns: Columns) -> list[str]:
    """Those of ``rig`` and ``specimen`` of which some unit has records in two splits: then scores are too good."""
    keys = [column(columns, name) for name in UNITS[:2]]
    split = column(columns, "split")
    return [name for name, of in zip(UNITS, (keys[:1], keys), strict=False) if distinct(*of, split) > distinct(*of)]


def clipped_records(columns: Columns) -> dict[str, int] | None:
    """Number of records with a clipped sample in each class that has one; None if clipped samples were not counted.

    >>> clipped_records({"fault": [0, 1, 1, 2], "clipped": [0, 3, 7, 1]}), clipped_records({"fault": [0]})
    ({'inner': 2, 'outer': 1}, None)
    """
    return class_counts(column(columns, "fault")[column(columns, "clipped") > 0]) if "clipped" in columns else None


def fault_counts(columns: Columns) -> FaultCounts | None:
    """Counts of the faults that can be seen in their records; None if the corpus was not simulated or has no record with a fault."""
    if not all(name in columns for name in OF_FAULTS):
        return None
    rig, specimen, detectable, fault_tries, level_tries = (
        column(columns, name) for name in ("rig", "specimen", *OF_FAULTS)
    )
    # whether a healthy record shows a fault is no question
    detectable = detectable[column(columns, "fault") != FAULTS.index("healthy")]
    if not detectable.size:
        return None
    return FaultCounts(
        records=detectable.size,
        detectable=int((detectable == 1).sum()),
        unjudged=int((detectable == UNJUDGED).sum()),
        redrawn_specimens=distinct(rig[fault_tries > 0], specimen[fault_tries > 0]),
        redrawn_levels=int((level_tries > 0).sum()),
    )


def step_complaint(columns: Columns) -> str | None:
    """Sentence with the number of records that follow their step rather than the model, and the key to change; None if there are none.

    The step of some records of a simulated corpus is checked, by integrating them again at half of it, and of no imported one.
    """
    if not ("step_error" in columns and "oversampling" in columns):
        return None
    error, steps = (column(columns, name) for name in ("step_error", "oversampling"))
    coarse = error > COARSE
    if not coarse.any():
        return None
    # a step finer than that of every coarse record helps all of them
    worst, finest = 100 * error.max(where=coarse, initial=0), steps[coarse].max()
    return (
        f"{coarse.sum():,} of the {np.isfinite(error).sum():,} records whose step was checked change by more than {100 * COARSE:g} % "
        f"(up to {worst:.0f} %) at half the step; raise recording.oversampling above {finest}."
    )
