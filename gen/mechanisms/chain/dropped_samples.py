"""Gaps in the data transfer."""

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault


class DroppedSamples(SensorFault):
    """Gaps in the data transfer, at the same times in all channels."""

    place, drawn_per = "dropped_samples", "record"
    labels = (
        Variable("dropped_samples", "i4", "1", "latent", "times at which all channels have a filling and no sample"),
    )

    probability: Probability
    """Share of the records with gaps."""
    count: Distribution = within(1, 1000)
    """Number of gaps in a record, rounded to a whole number; gaps may overlap."""
    gap_s: Distribution = within(0, 60, open_low=True)
    """Length of each gap of a record, such as the time of one packet; at least one sample."""
    held_percent: Distribution = within(0, 100, default=50.0)
    """Share of the gaps filled with the last sample before them; the others are filled with 0."""

    def problem(self, full_scale: float | None, duration: float) -> str | None:
        """A gap as long as a record."""
        longest = self.gap_s.support()[1]
        if longest < duration:
            return None
        return f"gap_s: {longest:g} s leaves nothing of a record; keep it below recording.duration_s {duration:g}."

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """Signal with gaps, each filled with the last sample before it or with 0.

        The first sample is never lost. Where gaps overlap, the later one is filled from what the earlier one left.
        """
        drawn = self.si()
        length = signal.shape[1]
        size = min(max(round(drawn["gap"] * fs), 1), length - 1)
        starts = np.sort(rng.integers(1, length - size + 1, size=round(drawn["count"])))
        held = rng.random(len(starts)) < drawn["held"]
        filled, lost = signal.copy(), np.zeros(length, bool)
        for start, hold in zip(starts, held, strict=True):
            gap = slice(start, start + size)
            filled[:, gap] = filled[:, start - 1 : start] if hold else 0.0
            # gaps may overlap, and a sample is lost once
            lost[gap] = True
        return filled, int(np.count_nonzero(lost))
