"""Impulses at random times."""

import numpy as np

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray
from gen.support.units import decibel_to_ratio


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
