"""A rotor that rubs: its seal or casing cuts the motion off once a turn, or every second turn, and rubs noise out of it.

See A. Muszynska, Rotordynamics, CRC Press, 2005, chapter 5: truncated waves, harmonics, and half orders where it touches every second turn.
"""

import math

import numpy as np

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.bursts import bursts_of
from gen.mechanisms.background.source import FloatArray, MachineCondition, Streams
from gen.support.units import decibel_to_ratio


class Rub(MachineCondition):
    """A rotor that touches its casing: a wave that is cut off, and a burst of noise while it touches."""

    place = "rub"

    probability: Probability
    """Share of the rigs whose rotor rubs."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Contacts in a turn of the shaft: 1, or 0.5 for every second turn."""
    contact_deg: Distribution = within(1, 180, default=60.0)
    """Length of a contact, in degrees from contact to contact."""
    level_db: Distribution = within(-80, 40)
    """Rms of the truncated wave relative to that of the background noise."""
    noise_db: Distribution = within(-80, 40)
    """Rms of the bursts of noise relative to that of the background noise."""

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> list[FloatArray]:
        """Wave without its top, and noise while it is in contact; the angle of the contact belongs to the rig."""
        drawn, start = self.si(), 2 * math.pi * stream(level="rig").random()
        phase, half = drawn["order"] * angles + start, drawn["contact"] / 2
        top = math.cos(half)
        # mean and mean square of the wave over a turn; a record may hold a part of one
        mean = (half * top - math.sin(half)) / math.pi
        square = (half * top**2 + (math.pi - half) / 2 - math.sin(2 * half) / 4) / math.pi
        wave = (np.minimum(np.cos(phase), top) - mean) / math.sqrt(square - mean**2)
        noise = bursts_of(phase, half, stream())
        return [decibel_to_ratio(drawn["level"]) * wave, decibel_to_ratio(drawn["noise"]) * noise]
