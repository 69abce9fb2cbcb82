"""Impulses of a machine: at random times, and locked to its shaft."""

import math

import numpy as np

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import FloatArray, MachineSource, Streams
from gen.support.units import decibel_to_ratio

_SCATTER = 0.2  # of the strength from strike to strike


class Impulses(MachineSource):
    """Impulses at random times, which no fault causes and which excite the path."""

    place = "impulses"

    probability: Probability
    """Share of the rigs that have these impulses."""
    rate_hz: Distribution = within(0.1, 1000)
    """Mean number of impulses per second."""
    level_db: Distribution = within(-80, 60)
    """Rms of their peaks behind the path, relative to the rms of the background noise."""

    def add_impulses(self, hits: FloatArray, angles: FloatArray, fs: float, stream: Streams) -> None:
        """Impulses at times that are random in each record."""
        drawn, rng = self.si(), stream()
        times = rng.integers(len(hits), size=rng.poisson(drawn["rate"] * len(hits) / fs))
        strengths = rng.standard_normal(len(times), dtype=np.float32)
        np.add.at(hits, times, decibel_to_ratio(drawn["level"]) * strengths)


class Knocks(MachineSource):
    """Impulses locked to the shaft, which no bearing fault causes and which excite the path."""

    place = "knocks"

    probability: Probability
    """Share of the rigs that have these impulses."""
    orders: Distribution = within(0.1, 20)
    """Number of impulses per turn of the shaft."""
    level_db: Distribution = within(-80, 60)
    """Mean of their peaks behind the path, relative to the rms of the background noise."""

    def add_impulses(self, hits: FloatArray, angles: FloatArray, fs: float, stream: Streams) -> None:
        """Impulses at angles of the shaft that belong to the rig."""
        drawn, start = self.si(), 2 * math.pi * stream(level="rig").random()
        add_strikes(hits, drawn["orders"] * angles + start, drawn["level"], stream())


def add_strikes(hits: FloatArray, phase: FloatArray, level: float, rng: np.random.Generator) -> None:
    """Add a strike at the beginning of each turn of a ``phase`` [rad], shape (time,); their mean strength is a ``level`` [dB]."""
    times = np.flatnonzero(np.diff(np.floor(phase / (2 * math.pi))) > 0) + 1
    scatter = _SCATTER * rng.standard_normal(len(times), dtype=np.float32)
    hits[times] += decibel_to_ratio(level) * (1 + scatter)
