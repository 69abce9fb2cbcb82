"""Impulses at random times."""

import numpy as np

from gen.drawing import Distribution, Drawn, Draws, Probability, within
from gen.mechanisms.background.source import BackgroundSource, FloatArray


class Impulses(BackgroundSource):
    """Impulses at random times, which no fault causes and which excite the path."""

    place = "impulses"

    probability: Probability
    """Share of the rigs that have these impulses."""
    rate_hz: Distribution = within(0.1, 1000)
    """Mean number of impulses per second."""
    level_db: Distribution = within(-80, 60)
    """Rms of their peaks behind the path, relative to the rms of the background noise."""

    def draw_present(self, draws: Draws) -> Drawn:
        """Mean rate [Hz] and level."""
        return {"frequency": draws.value(self.rate_hz), "level": draws.ratio(self.level_db)}


def add_impulses(hits: FloatArray, drawn: Drawn, fs: float, rng: np.random.Generator) -> None:
    """Add the strengths of impulses to the samples at which they start, shape (time,) [1]."""
    times = rng.integers(len(hits), size=rng.poisson(drawn["frequency"] * len(hits) / fs))
    np.add.at(hits, times, drawn["level"] * rng.standard_normal(len(times), dtype=np.float32))
