"""What a fault of the measuring chain is: a section of a recipe that draws itself, changes a signal, and labels what it did."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from gen.drawing import Drawn, Draws
from gen.mechanisms.mechanism import FloatArray, Mechanism, is_flat

Found = Mapping[str, float]
"""Values of the labels of a fault that is in a record, by name."""


class SensorFault(Mechanism):
    """A fault of mount, cable, amplifier or data transfer.

    One that lasts as long as an installation is drawn for the rig, one that comes and goes for the record. The numbers of its random
    streams are part of their seeds: they must not change, and a new fault takes the next free ones.
    """

    rig_stream: ClassVar[int | None] = None
    """Number of the stream from which it is drawn for a rig; None for a fault of records."""
    record_stream: ClassVar[int | None] = None
    """The same for a record; a fault of rigs with one is drawn in part anew for each record."""
    noise_stream: ClassVar[int]
    """Number of the stream of its random times and phases in a record."""

    def draw(self, draws: Draws, channels: int) -> Any:  # noqa: ARG002 - of each channel, for some faults
        """Drawn values of this fault; None if it does not occur."""
        return draws.section(self) if draws.is_present(self) else None

    def draw_anew(self, draws: Draws) -> Drawn:
        """Values of a fault of rigs that are drawn for each record."""
        raise NotImplementedError

    def problem(self, full_scale: float | None, duration: float) -> str | None:  # noqa: ARG002 - for some faults
        """Sentence about a key that can have no effect or no place in a record, from the key on; None if there is none.

        ``full_scale`` is that of the converter, None without one [m s-2]; ``duration`` is that of a record [s].
        """
        return None

    @staticmethod
    def has_form(drawn: Any, channels: int) -> bool:  # noqa: ARG004 - of each channel, for some faults
        """Whether drawn values, which may come from a file, have the form of those of this fault."""
        return is_flat(drawn)

    @staticmethod
    def disturb(drawn: Any, signal: FloatArray, fs: float, rng: np.random.Generator) -> tuple[FloatArray, Found]:
        """New signal with the fault, of the shape (channel, time) of ``signal`` [m s-2], and the values of its labels."""
        raise NotImplementedError
