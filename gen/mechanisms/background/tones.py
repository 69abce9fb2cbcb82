"""Spectral lines at fixed frequencies, such as those of other machines."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.physics.orbit import along
from gen.support.units import decibel_to_ratio

ComplexArray = NDArray[np.complexfloating]


class Tones(BackgroundSource):
    """Lines at fixed frequencies, such as those of other machines."""

    place = "tones"

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, rounded to a whole number."""
    frequency_hz: Distribution = within(1, 100_000, each=True)
    """Frequency of a line, drawn for each; the anti-alias filter removes it above half the sample rate."""
    level_db: Distribution = within(-80, 40, each=True)
    """Rms of a line relative to that of the background noise, drawn for each."""
    modulation: Distribution = within(0, 1, each=True, default=0.0)
    """Depth of the amplitude modulation of a line at 1x shaft rate, drawn for each."""


def tones_of_machine(
    background: Any, directions: FloatArray, stream: Callable[[str], np.random.Generator]
) -> tuple[FloatArray, ComplexArray, FloatArray, ComplexArray]:
    """Tones of a drawn background, whose phases are drawn from the streams of a rig.

    Returns
    -------
    array, shape (tone,)
        Amplitude [1].
    array, shape (direction, tone)
        Motion along some ``directions`` [rad] [1].
    array, shape (tone,)
        Frequency [Hz].
    array, shape (tone,)
        Modulation by the shaft [1].
    """
    none = dict.fromkeys(("level", "frequency", "modulation"), np.zeros(0))
    tones = none if background.tones is None else background.tones.si()
    forward, backward, flatness, phases = stream("phases of tones").random((4, len(tones["level"])))
    amplitudes = math.sqrt(2) * decibel_to_ratio(tones["level"])
    motion = along(directions, 2 * np.pi * forward, 2 * np.pi * backward, flatness)
    return amplitudes, motion, tones["frequency"], tones["modulation"] * np.exp(2j * np.pi * phases)
