"""Transfer path from bearing to sensor: a direct part, base-excited resonances, and modulation by the shaft."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Drawn, Draws, Probability, Section, within
from gen.physics.resonance import base_excited
from gen.support.units import percent_to_share

FloatArray = NDArray[np.floating]


class Modes(Section):
    """Resonances, drawn per rig."""

    count: Distribution = within(0, 16)
    """Number of resonances, rounded to a whole number."""
    frequency_hz: Distribution = within(10, 50_000)
    """Natural frequency of a resonance, drawn for each."""
    damping_percent: Distribution = within(0.05, 50)
    """Damping ratio of a resonance, drawn for each."""
    gain_db: Distribution = within(-80, 80, default=0.0)
    """Gain of a resonance relative to a direct part of 1; its sign is random."""


def draw_modes(draws: Draws, modes: Modes | None) -> tuple[Drawn, ...]:
    """Frequency [Hz], damping ratio and gain with its sign [1] of each resonance."""
    if modes is None:
        return ()
    drawn = []
    for _ in range(round(draws.value(modes.count))):
        frequency, damping = draws.value(modes.frequency_hz), percent_to_share(draws.value(modes.damping_percent))
        gain, sign = draws.ratio(modes.gain_db), 1.0 if draws.u() < 0.5 else -1.0
        drawn.append({"frequency": frequency, "damping": damping, "gain": sign * gain})
    return tuple(drawn)


def transmissibility(modes: Sequence[Drawn], frequency: FloatArray) -> NDArray[np.complex128]:
    """Sum of the transmissibilities of base-excited resonances, times their gains, shape (frequency,) [1]."""
    total = np.zeros(len(frequency), complex)
    for mode in modes:
        total += base_excited(frequency / mode["frequency"], mode["damping"], mode["gain"])
    return total


class Modulation(Section):
    """Amplitude modulation at one and two times the shaft rate: sidebands around every line."""

    probability: Probability
    """Share of the rigs that have the modulation."""
    first: Distribution = within(0, 1)
    """Depth of the modulation at 1x shaft rate, relative to the mean amplitude."""
    second: Distribution = within(0, 1)
    """Depth of the modulation at 2x shaft rate, relative to the mean amplitude."""


def draw_modulation(draws: Draws, modulation: Modulation | None) -> Drawn:
    """Depths once and twice per turn of the shaft [1]."""
    if modulation is None or not draws.is_present(modulation):
        return {"once": 0.0, "twice": 0.0}
    return {"once": draws.value(modulation.first), "twice": draws.value(modulation.second)}


def parts_of_modulation(modulation: Drawn, turns: FloatArray) -> FloatArray:
    """Parts of a modulation once per turn, then of that twice per turn, shape (4,) [1]; ``turns``, shape (2,), are their phases [turn]."""
    depths = np.array([modulation["once"], modulation["twice"]])
    phases = 2 * math.pi * turns
    return np.stack([depths * np.cos(phases), depths * np.sin(phases)], axis=1).ravel()


class PathSection(Section):
    """Linear transfer path from bearing to sensor, drawn per rig: a direct part and base-excited resonances."""

    direct: Distribution = within(0, 10, default=1.0)
    """Gain of the direct part, the same at all frequencies."""
    modes: Modes | None = None
    """Resonances of the path; none if left out."""
    modulation: Modulation | None = None
    """Modulation of the signal that the path transmits; none if left out."""

    def silent(self) -> bool:
        """Whether a drawn path may transmit nothing."""
        return self.direct.support()[1] == 0 and (self.modes is None or self.modes.count.support()[0] < 1)

    def draw(self, draws: Draws) -> Drawn:
        """Gain of the direct part [1], resonances and modulation of one path."""
        modulation, direct = draw_modulation(draws, self.modulation), draws.value(self.direct)
        return {"direct": direct, "modes": draw_modes(draws, self.modes), "modulation": modulation}
