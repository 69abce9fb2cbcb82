"""Noise that comes and goes with the shaft, as that of machines does with healthy bearings: several shaft orders stand in its envelope.

A burst is noise times ``exp(k (cos(n angle + start) - 1))``, a bell of the shaft angle whose width follows from ``k`` [1]_.

.. [1] N. I. Fisher, Statistical Analysis of Circular Data, Cambridge University Press, 1993, section 3.3.6.
"""

import math

import numpy as np

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import FloatArray, MachineSource, Streams
from gen.support.units import decibel_to_ratio


class Bursts(MachineSource):
    """Bursts of noise that come and go with the shaft, without an impact."""

    place = "bursts"

    probability: Probability
    """Share of the rigs that have these bursts."""
    level_db: Distribution = within(-80, 40)
    """Rms of the bursts relative to that of the background noise."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Number of bursts in a turn of the shaft."""
    length_deg: Distribution = within(1, 180, default=30.0)
    """Standard deviation of the amplitude of a burst about its middle, in degrees from burst to burst: 20 degrees put about three strong
    orders into the envelope, 8 degrees eight."""

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> list[FloatArray]:
        """Bursts, whose angle belongs to the rig."""
        drawn, start = self.si(), 2 * math.pi * stream(level="rig").random()
        bursts = bursts_of(drawn["order"] * angles + start, drawn["length"], stream())
        return [decibel_to_ratio(drawn["level"]) * bursts]


def bursts_of(phase: FloatArray, length: float, rng: np.random.Generator) -> FloatArray:
    """Bursts of unit rms over a turn, ``length`` [rad] long, about the multiples of a turn of their ``phase`` [rad], shape (time,) [1]."""
    from scipy.special import i0e  # loads SciPy: a recipe is read without it

    bells = np.exp((np.cos(phase) - 1) / length**2)
    # mean of the squared bell over a turn; a record without a burst has its tail alone
    return bells / math.sqrt(i0e(2 / length**2)) * rng.standard_normal(len(phase))
