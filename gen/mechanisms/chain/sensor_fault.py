"""What a fault of the measuring chain is: a section of a recipe that changes a signal, and labels what it did."""

from collections.abc import Mapping

import numpy as np

from gen.mechanisms.mechanism import FloatArray, Mechanism

Found = Mapping[str, float]
"""Values of the labels of a fault that is in a record, by name."""


class SensorFault(Mechanism):
    """A fault of mount, cable, amplifier or data transfer.

    One that lasts as long as an installation is drawn for the rig, one that comes and goes for the record.
    """

    def problem(self, full_scale: float | None, duration: float) -> str | None:  # noqa: ARG002 - for some faults
        """Sentence about a key that can have no effect or no place in a record, from the key on; None if there is none.

        ``full_scale`` is that of the converter, None without one [m s-2]; ``duration`` is that of a record [s].
        """
        return None

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> tuple[FloatArray, Found]:
        """New signal with the fault, of the shape (channel, time) of ``signal`` [m s-2], and the values of its labels."""
        raise NotImplementedError
