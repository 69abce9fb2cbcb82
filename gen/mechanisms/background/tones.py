"""Lines at fixed frequencies."""

import math

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.physics.orbit import along
from gen.support.units import decibel_to_ratio

ComplexArray = NDArray[np.complex128]


class Tones(BackgroundSource):
    """Lines at fixed frequencies, such as those of other machines."""

    place = "tones"

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, rounded to a whole number."""
    frequency_hz: Distribution = within(1, 100_000, each=True)
    """Frequency of a line, drawn for each; above half the sample rate it aliases."""
    level_db: Distribution = within(-80, 40, each=True)
    """Rms of a line relative to that of the background noise, drawn for each."""
    modulation: Distribution = within(0, 1, each=True, default=0.0)
    """Depth of the amplitude modulation of a line at 1x shaft rate, drawn for each."""


def motion_of_tones(
    tones: Tones | None, directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray, ComplexArray, ComplexArray]:
    """Frequency [Hz], amplitude and modulation by the shaft of each tone, shape (tone,), and its motion along some ``directions`` [rad].

    The motion has the shape (direction, tone) [1].
    """
    drawn = {name: np.zeros(0) for name in ("frequency", "level", "modulation")} if tones is None else tones.si()
    forward, backward, flatness, phases = rng.random((4, len(drawn["level"])))
    modulation = drawn["modulation"] * np.exp(2j * np.pi * phases)
    motion = along(directions, 2 * np.pi * forward, 2 * np.pi * backward, flatness)
    return drawn["frequency"], math.sqrt(2) * decibel_to_ratio(drawn["level"]), modulation, motion
