"""Transfer path from bearing to sensor: a direct part, base-excited resonances, and modulation by the shaft."""

import math

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Probability, Section, within
from gen.physics.resonance import base_excited
from gen.support.units import decibel_to_ratio

FloatArray = NDArray[np.floating]


class Modes(Section):
    """Resonances, drawn per rig."""

    count: Distribution = within(0, 16)
    """Number of resonances, rounded to a whole number."""
    frequency_hz: Distribution = within(10, 50_000, each=True)
    """Natural frequency of a resonance, drawn for each."""
    damping_percent: Distribution = within(0.05, 50, each=True)
    """Damping ratio of a resonance, drawn for each."""
    gain_db: Distribution = within(-80, 80, each=True, default=0.0)
    """Gain of a resonance relative to a direct part of 1, drawn for each."""
    sign: Distribution = within(-1, 1, each=True, default="choice(-1, 1)")
    """Sign of that gain, 1 or -1, drawn for each."""


def transmissibility(modes: Modes | None, frequency: FloatArray) -> NDArray[np.complex128]:
    """Sum of the transmissibilities of drawn base-excited resonances, times their gains, shape (frequency,) [1]."""
    total = np.zeros(len(frequency), complex)
    if modes is not None:
        drawn = modes.si()
        gains = drawn["sign"] * decibel_to_ratio(drawn["gain"])
        for natural, damping, gain in zip(drawn["frequency"], drawn["damping"], gains, strict=True):
            total += base_excited(frequency / natural, damping, gain)
    return total


class Modulation(Section):
    """Amplitude modulation at one and two times the shaft rate: sidebands around every line."""

    probability: Probability
    """Share of the rigs that have the modulation."""
    first: Distribution = within(0, 1)
    """Depth of the modulation at 1x shaft rate, relative to the mean amplitude."""
    second: Distribution = within(0, 1)
    """Depth of the modulation at 2x shaft rate, relative to the mean amplitude."""


def modulation_by_shaft(modulation: Modulation | None, turns: FloatArray) -> NDArray[np.complexfloating]:
    """Complex depth of a drawn modulation once and twice per turn, shape (2,) [1]; ``turns``, shape (2,), are their phases."""
    depths = np.zeros(2) if modulation is None else np.array([*modulation.si().values()])
    phases = 2 * math.pi * turns
    return depths * np.cos(phases) + 1j * (depths * np.sin(phases))


class PathSection(Section):
    """Linear transfer path from bearing to sensor, drawn per rig: a direct part and base-excited resonances."""

    drawn_per = "rig"

    direct: Distribution = within(0, 10, default=1.0)
    """Gain of the direct part, the same at all frequencies."""
    modes: Modes | None = None
    """Resonances of the path; none if left out."""
    modulation: Modulation | None = None
    """Modulation of the signal that the path transmits; none if left out."""

    def silent(self) -> bool:
        """Whether a drawn path may transmit nothing."""
        return self.direct.support()[1] == 0 and (self.modes is None or self.modes.count.support()[0] < 1)
