"""Sudden changes of the sensitivity."""

from typing import Any

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Drawn, Draws, Probability, within
from gen.mechanisms.chain.sensor_fault import FloatArray, Found, SensorFault
from gen.mechanisms.mechanism import is_flat
from gen.support.units import decibel_to_ratio


class GainSteps(SensorFault):
    """Sudden changes of the sensitivity: a range that switches, a contact that fails; the same for all channels."""

    place, record_stream, noise_stream = "gain_steps", 2, 5
    labels = (Variable("gain_steps", "i4", "1", "latent", "sudden changes of the gain within the record"),)

    probability: Probability
    """Share of the records with such steps."""
    count: Distribution = within(1, 20)
    """Number of steps in a record, rounded to a whole number; their times are random."""
    step_db: Distribution = within(-60, 60)
    """Change of the gain at a step, drawn for each; the gain is 0 dB before the first."""

    def draw(self, draws: Draws, channels: int) -> Any:  # noqa: ARG002
        """Place in the record [share of its length] and factor of the gain [1] of each step, in order of time."""
        if not draws.is_present(self):
            return None
        steps: list[Drawn] = [
            {"share": draws.u(), "gain": decibel_to_ratio(draws.value(self.step_db))}
            for _ in range(round(draws.value(self.count)))
        ]
        steps.sort(key=lambda step: step["share"])
        return tuple(steps)

    @staticmethod
    def has_form(drawn: Any, channels: int) -> bool:  # noqa: ARG004
        """Any number of steps."""
        return isinstance(drawn, tuple) and all(map(is_flat, drawn))

    @staticmethod
    def disturb(
        drawn: tuple[Drawn, ...],
        signal: FloatArray,
        fs: float,  # noqa: ARG004
        rng: np.random.Generator,  # noqa: ARG004
    ) -> tuple[FloatArray, Found]:
        """Signal times a gain, which every step multiplies."""
        length = signal.shape[1]
        gain = np.ones(length)
        for step in drawn:
            gain[1 + int(step["share"] * (length - 1)) :] *= step["gain"]
        return signal * gain, {"gain_steps": len(drawn)}
