"""The time axis of a record: settling, lead, and the record itself.

A knot is one output sample of the kernel. The kernel starts ``settle`` samples before the record. The response that it returns starts
``lead`` samples before the record, so that the filters of the measurement have settled where the record begins::

    knot      0 ............................ settle - lead ....... settle ...................... settle + record
              |  settles, dropped            |  lead, kept for     |  record                     |
              |                              |  the filters        |                             |
    time [s]  -settle / fs                   -LEAD_S               0                             duration
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel.decimate import LAG
from gen.recipe import Recipe

FloatArray = NDArray[np.float64]

LEAD_S = 0.05


class Timeline(NamedTuple):
    """Counts in samples of the rate ``fs`` [Hz]."""

    fs: float
    settle: int
    lead: int
    record: int

    @property
    def dropped(self) -> int:
        """Samples that settle and are not returned."""
        return max(self.settle - self.lead, 0)

    @property
    def returned(self) -> int:
        """Samples of a response: lead and record."""
        return self.lead + self.record

    @property
    def knots(self) -> int:
        """Knots at which speed and load are needed: the filters of the kernel look some samples ahead."""
        return self.settle + self.record + LAG + 2

    @property
    def kept(self) -> slice:
        """Place of the record in a response."""
        return slice(self.lead, self.lead + self.record)

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return self.record / self.fs

    def knot_times(self) -> FloatArray:
        """Times of all knots, shape (knot,), 0 at the start of the record [s]."""
        return (np.arange(self.knots) - self.settle) / self.fs


def timeline(recipe: Recipe) -> Timeline:
    """Time axis of the records of a recipe."""
    fs = recipe.recording.sample_rate_hz
    return Timeline(fs, round(recipe.recording.settle_s * fs), round(LEAD_S * fs), recipe.n_samples)
