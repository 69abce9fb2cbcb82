"""Records that change when they are integrated again at half the step: their signals follow the step, not the model."""

from collections.abc import Mapping
from typing import Any

import numpy as np

COARSE = 0.05  # relative rms change of the motion; a step of the usual fineness changes a record by some thousandths


def step_complaint(columns: Mapping[Any, Any]) -> str | None:
    """Sentence with the number of records whose step is too coarse and the key to change; None if there are none.

    ``columns`` has the variables of a corpus by name: an opened corpus, or arrays.
    The step of some records of a simulated corpus is checked, and of no imported one.
    """
    if not {"step_error", "oversampling"} <= columns.keys():
        return None
    error, steps = (np.asarray(columns[name]) for name in ("step_error", "oversampling"))
    coarse = error > COARSE
    if not coarse.any():
        return None
    worst, finest = 100 * error.max(where=coarse, initial=0), steps[coarse].max()
    return (
        f"{coarse.sum():,} of the {np.isfinite(error).sum():,} records whose step was checked change by more than {100 * COARSE:g} % "
        f"(up to {worst:.0f} %) at half the step; raise recording.oversampling above {finest}."
    )
