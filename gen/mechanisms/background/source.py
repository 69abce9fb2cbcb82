"""What a source of vibration in the machine is: a section of a recipe that some rigs have."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from gen.mechanisms.mechanism import FloatArray, Mechanism

Vibration = NDArray[np.inexact]
Streams = Callable[..., np.random.Generator]
"""Gives the random stream of a source in a record, or that in a rig: ``stream(level="rig")``."""


class BackgroundSource(Mechanism):
    """A source that some rigs have; its levels are relative to the rms of the noise."""

    drawn_per = "rig"


class MachineSource(BackgroundSource):
    """A source that is computed ahead of the paths, from the angle of the shaft, random numbers, or both: vibrations, impulses, or both.

    ``angles`` are those of the shaft [rad], shape (time,), and ``fs`` is the sample rate [Hz]. The ``stream`` of the rig gives phases that
    belong to it, that of the record what is random in a record. Each call of ``stream`` begins with the same numbers again.
    """

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> Sequence[Vibration]:
        """Vibrations over the rms of the background noise, shape (time,) each [1].

        A real vibration is the same in all directions. A complex one is a motion: its real part is horizontal, its imaginary part vertical.
        Each has its rms ahead of the paths and, over all channels, behind them; resonances shift power among its lines.
        """
        return ()

    def add_impulses(self, hits: FloatArray, angles: FloatArray, fs: float, stream: Streams) -> None:
        """Add impulses to the samples at which they start, shape (time,): their peaks behind the path over the rms of the noise [1]."""


class MachineCondition(MachineSource):
    """What a machine has that is not well, whatever its bearings: its key is its name in the label ``machine_condition``."""
