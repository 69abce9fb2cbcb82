"""Oscillations that a switching contact induces."""

import math

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault, recursive


class EmiBursts(SensorFault):
    """Short oscillations that a switching contact or converter induces in the cables, the same in all channels."""

    place, drawn_per = "emi_bursts", "record"
    labels = (Variable("emi_bursts", "i4", "1", "latent", "induced bursts that start within the record"),)

    probability: Probability
    """Share of the records near such a source."""
    rate_hz: Distribution = within(0.1, 1000)
    """Mean number of bursts per second, at random times."""
    frequency_hz: Distribution = within(10, 100_000)
    """Frequency of the oscillation; above half the sample rate it aliases."""
    decay_s: Distribution = within(1e-5, 1)
    """Time in which a burst decays to 37 %."""
    peak_m_s2: Distribution = within(0, 1e5, open_low=True)
    """Rms of the peaks of the bursts."""

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """Signal with decaying oscillations that start at random times."""
        drawn = self.si()
        length = signal.shape[1]
        count = int(rng.poisson(drawn["rate"] * length / fs))
        starts = rng.integers(length, size=count)
        peaks = drawn["peak"] * rng.standard_normal(count) * np.exp(2j * math.pi * rng.random(count))
        hits = np.zeros(length, complex)
        np.add.at(hits, starts, peaks)
        pole = np.exp((-1 / drawn["decay"] + 2j * math.pi * drawn["frequency"]) / fs)
        return signal + np.real(recursive(1.0, pole, hits)), count
