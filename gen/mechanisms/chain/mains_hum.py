"""Hum of the power supply."""

import math

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault
from gen.support.units import decibel_to_ratio


class MainsHum(SensorFault):
    """Hum of the power supply, common to all channels."""

    place, drawn_per = "mains_hum", "rig"
    labels = (Variable("mains_hum", "f8", "m s-2", "latent", "rms of the hum of the mains, 0 without"),)

    probability: Probability
    """Share of the rigs with hum."""
    frequency_hz: Distribution = within(10, 500, default=50.0)
    """Nominal frequency of the mains: 50 or 60 in most countries."""
    deviation_percent: Distribution = within(-10, 10, default=0.0, per="record")
    """Deviation of the mains from its nominal frequency, drawn for each record."""
    rms_m_s2: Distribution = within(0, 1e4, open_low=True)
    """Rms of the hum at the mains frequency."""
    count: Distribution = within(0, 40, default=3.0)
    """Number of odd multiples (3x, 5x, ...) beside the mains frequency, rounded to a whole number."""
    third_db: Distribution = within(-80, 20, default=-10.0)
    """Level of the third multiple relative to the mains frequency; the others fall as one over their order."""

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """Signal with the mains frequency and its odd multiples below half the sample rate."""
        drawn = self.si()
        length = signal.shape[1]
        orders = 1 + 2 * np.arange(round(drawn["count"]) + 1)
        phases = rng.random(len(orders)) * 2 * math.pi
        frequencies = orders * drawn["frequency"] * (1 + drawn["deviation"])
        # odd multiples fall as 1/order from the third on
        levels = drawn["rms"] * np.where(orders == 1, 1.0, 3 * decibel_to_ratio(drawn["third"]) / orders)
        hum = np.zeros(length)
        for frequency, level, phase in zip(frequencies, levels, phases, strict=True):
            if frequency < fs / 2:
                hum += math.sqrt(2) * level * np.cos(2 * math.pi * frequency / fs * np.arange(length) + phase)
        return signal + hum, math.sqrt(np.mean(hum**2))
