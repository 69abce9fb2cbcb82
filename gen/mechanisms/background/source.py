"""What a source of vibration in the machine is: a section of a recipe that draws itself for a rig."""

from typing import Any, ClassVar

import numpy as np

from gen.drawing import Drawn, Draws, Purpose
from gen.mechanisms.mechanism import FloatArray, Mechanism


class BackgroundSource(Mechanism):
    """A source that some rigs have. It is drawn from the stream of the rig; its levels are relative to the rms of the noise."""

    def draw(self, draws: Draws) -> Any:
        """Drawn values in SI units, levels as ratios; None if the rig has no such source."""
        return self.draw_present(draws) if draws.is_present(self) else None

    def draw_present(self, draws: Draws) -> Any:
        """Drawn values of a source that the rig has."""
        raise NotImplementedError


class LockedSource(BackgroundSource):
    """A source whose vibration follows from the angle of the shaft, ahead of the paths.

    It has streams of its own for a rig and for a record, so that it moves no other drawn value.
    """

    of_rig: ClassVar[Purpose]
    of_record: ClassVar[Purpose]

    @staticmethod
    def vibrations(drawn: Drawn, angles: FloatArray, fs: float, rng: np.random.Generator) -> list[FloatArray]:
        """Vibrations over the rms of the background noise, for ``angles`` of the shaft [rad], shape (time,) each [1].

        Each has its rms ahead of the paths and, over all channels, behind them. ``fs`` is the sample rate [Hz].
        """
        raise NotImplementedError
