"""A recording in memory: its channels, sample rate, name and unit."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ACCELERATION = "m/s²"
LONGEST = 60.0  # s; of a longer recording the beginning is used


class Recorded(NamedTuple):
    """A recording: signals of equal length by the name of their channel, shape (time,), sample rate [Hz], name, unit, and stated speed.

    ``matched`` has the variables of a MATLAB file that patterns among the names chose.
    """

    signals: Mapping[str, FloatArray]
    fs: float
    name: str = "the recording"
    unit: str = ACCELERATION
    rpm: float | None = None
    matched: Mapping[str, str] = {}

    @property
    def duration(self) -> float:
        """Length [s]."""
        return len(next(iter(self.signals.values()))) / self.fs

    def renamed(self, names: Mapping[str, str]) -> "Recorded":
        """The recording with other names of some channels."""
        return self._replace(signals={names.get(name, name): signal for name, signal in self.signals.items()})

    @property
    def used(self) -> "Recorded":
        """At most the first 60 s."""
        most = round(LONGEST * self.fs)
        return self._replace(signals={name: signal[:most] for name, signal in self.signals.items()})
