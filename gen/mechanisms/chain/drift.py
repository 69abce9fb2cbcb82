"""Baselines that move slowly."""

import math

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault, recursive


class Drift(SensorFault):
    """A baseline that moves slowly: warming of the sensor, and settling after it was switched on or struck."""

    place, drawn_per = "drift", "record"
    labels = (
        Variable(
            "drift", "f8", "m s-2", "latent", "largest deviation of the baseline from 0 in any channel, 0 without drift"
        ),
    )

    probability: Probability
    """Share of the records with drift; each channel drifts by itself."""
    wander_m_s2: Distribution = within(0, 1e4, default=0.0)
    """Rms of a random baseline."""
    wander_corner_hz: Distribution = within(1e-4, 100, default=0.2)
    """Frequency above which the power spectral density of the random baseline falls with the square of the frequency."""
    settling_m_s2: Distribution = within(-1e4, 1e4, default=0.0)
    """Baseline at the start of the record that decays exponentially."""
    settling_time_s: Distribution = within(1e-3, 1e3, default=1.0)
    """Time constant of that decay."""

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """Signal on a random wander and an exponential settling.

        The wander is white noise behind a low-pass filter of first order, stationary from the first sample on.
        """
        drawn = self.si()
        channels, length = signal.shape
        kept = math.exp(-2 * math.pi * drawn["wander_corner"] / fs)
        noise = rng.standard_normal(signal.shape) * (drawn["wander"] * math.sqrt(1 - kept**2))
        noise[:, 0] = drawn["wander"] * rng.standard_normal(channels)
        settling = drawn["settling"] * np.exp(np.arange(length) / (-drawn["settling_time"] * fs))
        baseline = recursive(1.0, kept, noise) + settling
        return signal + baseline, float(np.abs(baseline).max())
