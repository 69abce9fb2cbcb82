"""Spectral lines of a machine: at multiples of the shaft rate, and at fixed frequencies."""

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

FLATTEST = 0.8  # orbit at a harmonic: the shaft never moves along a straight line


class Harmonics(BackgroundSource):
    """Lines at multiples of the shaft rate."""

    place = "harmonics"

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, at 1x, 2x, ... shaft rate; rounded to a whole number."""
    level_db: Distribution = within(-80, 40, each=True)
    """Rms of a line relative to that of the background noise, drawn for each; the mean over all directions and channels."""
    growth: Distribution = within(0, 4, default=0.0)
    """Power of the speed with which the lines grow along `operation.speed_profile`; 2 is that of an unbalance."""


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


def lines_of_machine(
    background: Any, directions: FloatArray, stream: Callable[[str], np.random.Generator]
) -> tuple[FloatArray, ComplexArray, FloatArray, ComplexArray]:
    """Lines of a drawn background, the harmonics and then the tones, whose phases are drawn from the streams of a rig.

    Returns
    -------
    array, shape (line,)
        Amplitude [1].
    array, shape (direction, line)
        Motion along some ``directions`` [rad] [1]. The first harmonic is in phase with the unbalance, which points along the mark of the
        shaft.
    array, shape (tone,)
        Frequency [Hz].
    array, shape (tone,)
        Modulation by the shaft [1].
    """
    none = dict.fromkeys(("level", "frequency", "modulation"), np.zeros(0))
    harmonics, tones = (none if source is None else source.si() for source in (background.harmonics, background.tones))
    of_harmonics = stream("phases of harmonics").random((3, len(harmonics["level"])))
    of_harmonics[0, :1] = 0.0
    of_harmonics[2] *= FLATTEST
    *of_tones, phases = stream("phases of tones").random((4, len(tones["level"])))
    forward, backward, flatness = np.concatenate([of_harmonics, of_tones], axis=1)
    amplitudes = math.sqrt(2) * decibel_to_ratio(np.concatenate([harmonics["level"], tones["level"]]))
    motion = along(directions, 2 * np.pi * forward, 2 * np.pi * backward, flatness)
    return amplitudes, motion, tones["frequency"], tones["modulation"] * np.exp(2j * np.pi * phases)
