"""Sudden changes of the sensitivity."""

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault
from gen.support.units import decibel_to_ratio


class GainSteps(SensorFault):
    """Sudden changes of the sensitivity: a range that switches, a contact that fails; the same for all channels."""

    place, drawn_per = "gain_steps", "record"
    labels = (Variable("gain_steps", "i4", "1", "latent", "sudden changes of the gain within the record"),)

    probability: Probability
    """Share of the records with such steps."""
    count: Distribution = within(1, 20)
    """Number of steps in a record, rounded to a whole number; their times are random."""
    step_db: Distribution = within(-60, 60, each=True)
    """Change of the gain at a step, drawn for each; the gain is 0 dB before the first."""

    def disturb(
        self,
        signal: FloatArray,
        fs: float,
        rng: np.random.Generator,
    ) -> Disturbed:
        """Signal times a gain, which every step multiplies; the steps are at random times."""
        length, steps = signal.shape[1], decibel_to_ratio(self.si()["step"])
        gain = np.ones(length)
        for share, step in zip(np.sort(rng.random(len(steps))), steps, strict=True):
            gain[1 + int(share * (length - 1)) :] *= step
        return signal * gain, len(steps)
