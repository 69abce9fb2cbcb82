"""Lines at fixed frequencies."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Drawn, Draws, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.physics.orbit import along


class Tones(BackgroundSource):
    """Lines at fixed frequencies, such as those of other machines."""

    place = "tones"

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, rounded to a whole number."""
    frequency_hz: Distribution = within(1, 100_000)
    """Frequency of a line, drawn for each; above half the sample rate it aliases."""
    level_db: Distribution = within(-80, 40)
    """Rms of a line relative to that of the background noise, drawn for each."""
    modulation: Distribution = within(0, 1, default=0.0)
    """Depth of the amplitude modulation of a line at 1x shaft rate, drawn for each."""

    def draw_present(self, draws: Draws) -> tuple[Drawn, ...]:
        """Level, frequency [Hz] and modulation of each line."""
        lines = []
        for _ in range(round(draws.value(self.count))):
            level, frequency = draws.ratio(self.level_db), draws.value(self.frequency_hz)
            lines.append({"level": level, "frequency": frequency, "modulation": draws.value(self.modulation)})
        return tuple(lines)


def motion_of_tones(
    drawn: Sequence[Drawn], fs: float, directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, NDArray[np.complex128]]:
    """Angle per sample [rad], amplitude, and parts of the modulation by the shaft of each tone, shape (tone, 4); and its motion.

    The motion is that along some ``directions`` [rad], shape (direction, tone) [1].
    """
    forward, backward, flatness, phases = rng.random((4, len(drawn)))
    depths = np.array([tone["modulation"] for tone in drawn])
    steps = np.array([2 * math.pi * tone["frequency"] / fs for tone in drawn])
    levels = np.array([math.sqrt(2) * tone["level"] for tone in drawn])
    tones = np.stack([steps, levels, depths * np.cos(2 * np.pi * phases), depths * np.sin(2 * np.pi * phases)], axis=1)
    return tones, along(directions, 2 * np.pi * forward, 2 * np.pi * backward, flatness)
