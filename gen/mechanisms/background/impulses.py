"""Impulses of a machine: at random times, and locked to its shaft."""

import math

import numpy as np

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.support.units import decibel_to_ratio

_SCATTER = 0.2  # of the strength from knock to knock


class Impulses(BackgroundSource):
    """Impulses at random times, which no fault causes and which excite the path."""

    place = "impulses"

    probability: Probability
    """Share of the rigs that have these impulses."""
    rate_hz: Distribution = within(0.1, 1000)
    """Mean number of impulses per second."""
    level_db: Distribution = within(-80, 60)
    """Rms of their peaks behind the path, relative to the rms of the background noise."""

    def add_to(self, hits: FloatArray, fs: float, rng: np.random.Generator) -> None:
        """Add the strengths of impulses to the samples at which they start, shape (time,) [1]."""
        drawn = self.si()
        times = rng.integers(len(hits), size=rng.poisson(drawn["rate"] * len(hits) / fs))
        strengths = rng.standard_normal(len(times), dtype=np.float32)
        np.add.at(hits, times, decibel_to_ratio(drawn["level"]) * strengths)


class Knocks(BackgroundSource):
    """Impulses locked to the shaft, which no bearing fault causes and which excite the path."""

    place = "knocks"

    probability: Probability
    """Share of the rigs that have these impulses."""
    orders: Distribution = within(0.1, 20)
    """Number of impulses per turn of the shaft."""
    level_db: Distribution = within(-80, 60)
    """Mean of their peaks behind the path, relative to the rms of the background noise."""

    def add_to(
        self, hits: FloatArray, angles: FloatArray, rng: np.random.Generator, of_rig: np.random.Generator
    ) -> None:
        """Add the strengths of knocks to the samples at which they start, shape (time,) [1], for ``angles`` of the shaft [rad].

        The phase of the knocks is drawn from the stream ``of_rig``.
        """
        drawn, phase = self.si(), 2 * math.pi * of_rig.random()
        times = np.flatnonzero(np.diff(np.floor((drawn["orders"] * angles + phase) / (2 * math.pi))) > 0) + 1
        scatter = _SCATTER * rng.standard_normal(len(times), dtype=np.float32)
        hits[times] += decibel_to_ratio(drawn["level"]) * (1 + scatter)
