"""Amplifiers of a limited range."""

import math

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault, recursive


class Saturation(SensorFault):
    """An amplifier whose range ends below the full scale of the converter, so that no clipped count reveals the overload."""

    place, drawn_per = "saturation", "rig"
    labels = (
        Variable("saturated", "i4", "1", "latent", "samples at the limit of the amplifier, all channels together"),
    )

    probability: Probability
    """Share of the rigs with such an amplifier."""
    limit_m_s2: Distribution = within(0, 1e6, open_low=True)
    """Largest output of the amplifier, as acceleration; the same for all channels."""
    knee_percent: Distribution = within(0, 100, default=0.0)
    """Upper part of the range in which the gain falls smoothly to 0; 0 limits the signal at once."""
    recovery_s: Distribution = within(0, 10, default=0.0)
    """Time constant in which an overload charges the amplifier and it discharges again: a shifted baseline; 0 for no shift."""

    def problem(self, full_scale: float | None, duration: float) -> str | None:
        """A limit that the converter never lets the signal reach."""
        lowest = self.limit_m_s2.support()[0]
        if full_scale is None or lowest < full_scale:
            return None
        return (
            f"limit_m_s2: {lowest:g} is not below recording.converter.full_scale_m_s2 {full_scale:g}, so the converter clips first; "
            "lower the limit."
        )

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """Signal behind the amplifier.

        Below the knee the gain is 1; in the knee it falls linearly with the input to 0, where the output reaches the limit. The part of
        the input beyond the limit charges the amplifier, which shifts the baseline to the other side and discharges with the same time
        constant.
        """
        drawn = self.si()
        limit, knee = drawn["limit"], drawn["knee"] * drawn["limit"]
        if drawn["recovery"] > 0:
            # what lies beyond the limit charges a low pass, whose output shifts the baseline
            kept = math.exp(-1 / (drawn["recovery"] * fs))
            beyond = signal - np.clip(signal, -limit, limit)
            signal = signal - recursive(1 - kept, kept, beyond)
        count = int(np.count_nonzero(np.abs(signal) >= limit + knee))
        output = np.clip(signal, -limit - knee, limit + knee)
        # the gain falls linearly to 0 within the knee: a parabola in the output
        if knee > 0:
            over = np.maximum(np.abs(output) - (limit - knee), 0.0)
            output -= np.copysign(over**2 / (4 * knee), output)
        return output, count
