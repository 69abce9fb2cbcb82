"""Counts of the faults that can be seen in their records, and of those that were drawn again."""

from typing import NamedTuple

import numpy as np
import xarray as xr

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


def fault_counts(corpus: xr.Dataset) -> FaultCounts | None:
    """Counts of a corpus; None if it was not simulated or has no record with a fault."""
    if not set(VARIABLES) <= set(corpus.variables):
        return None
    faulty = corpus["fault"].values != FAULTS.index("healthy")
    detectable = corpus["detectable"].values[faulty]
    if not detectable.size:
        return None
    return FaultCounts(
        records=detectable.size,
        detectable=int((detectable == 1).sum()),
        unjudged=int((detectable == UNJUDGED).sum()),
        redrawn_specimens=np.unique(corpus["specimen"].values[corpus["fault_tries"].values > 0]).size,
        redrawn_levels=int((corpus["level_tries"].values > 0).sum()),
    )
