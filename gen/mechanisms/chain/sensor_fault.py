"""What a fault of the measuring chain is: a section of a recipe that changes a signal, and labels what it did."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.mechanisms.mechanism import FloatArray, Mechanism

Disturbed = tuple[FloatArray, *tuple[float, ...]]
"""Signal with a fault, then the value of each of its labels."""


class SensorFault(Mechanism):
    """A fault of mount, cable, amplifier or data transfer.

    One that lasts as long as an installation is drawn for the rig, one that comes and goes for the record.
    """

    def problem(self, full_scale: float | None, duration: float) -> str | None:
        """Sentence about a key that can have no effect or no place in a record, from the key on; None if there is none.

        ``full_scale`` is that of the converter, None without one [m s-2]; ``duration`` is that of a record [s].
        """
        return None

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """New signal with the fault, of the shape (channel, time) of ``signal`` [m s-2], then the value of each of its labels."""
        raise NotImplementedError


def recursive(gain: float, pole: complex, signal: NDArray[Any]) -> NDArray[Any]:
    """Filter of first order along time: ``gain`` times the signal plus ``pole`` times the output one sample before."""
    from scipy.signal import lfilter  # loads for half a second, and few recipes need it

    return lfilter([gain], [1.0, -pole], signal)
