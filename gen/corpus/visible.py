"""Counts of the faults that can be seen in their records, and of those that were drawn again."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from gen.corpus.schema import FAULTS

UNJUDGED = 2  # value of ``detectable`` of a fault that was not judged


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


VARIABLES = ("detectable", "fault_tries", "level_tries")


def fault_counts(columns: Mapping[Any, Any]) -> FaultCounts | None:
    """Counts of an opened corpus, or of its variables as arrays by name; None if it was not simulated or has no record with a fault."""
    if not set(VARIABLES) <= columns.keys():
        return None
    fault, specimen, detectable, fault_tries, level_tries = (
        np.asarray(columns[name]) for name in ("fault", "specimen", *VARIABLES)
    )
    detectable = detectable[fault != FAULTS.index("healthy")]
    if not detectable.size:
        return None
    return FaultCounts(
        records=detectable.size,
        detectable=int((detectable == 1).sum()),
        unjudged=int((detectable == UNJUDGED).sum()),
        redrawn_specimens=np.unique(specimen[fault_tries > 0]).size,
        redrawn_levels=int((level_tries > 0).sum()),
    )
