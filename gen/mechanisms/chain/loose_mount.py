"""Sensors that are not held firmly."""

import math
from typing import Annotated, Any

import numpy as np
from pydantic import Field, StrictInt

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Draws, Probability, within
from gen.mechanisms.chain.sensor_fault import Disturbed, FloatArray, SensorFault
from gen.physics.resonance import base_excited

DECAYED = 7.0  # time constants after which a filter has settled to 1e-3


class LooseMount(SensorFault):
    """A sensor that is not held firmly: mount and sensor resonate, and the sensor lifts off and strikes the machine (rattle)."""

    place, drawn_per = "loose_mount", "rig"
    labels = (
        Variable("loose_mount", "i4", "1", "latent", "channels whose sensor is mounted loosely"),
        Variable("rattle", "i4", "1", "latent", "impacts of loose sensors on the machine, all channels together"),
    )

    probability: Probability
    """Share of the sensors that are mounted loosely; drawn per rig for each channel."""
    loose_channels: Annotated[tuple[Annotated[StrictInt, Field(ge=0, le=5)], ...], Field(min_length=1)] | None = None
    """Places of the channels with such a sensor, from 0; drawn for each channel if left out."""
    frequency_hz: Distribution = within(50, 20_000, each=True)
    """Resonance of the sensor on its mount, drawn for each: the looser the mount, the lower it is."""
    damping_percent: Distribution = within(0.1, 50, each=True)
    """Damping ratio of that resonance."""
    holding_m_s2: Distribution = within(0, 1e6, open_low=True, each=True)
    """Force that holds the sensor over its mass; the sensor lifts off where it would have to follow with more than this acceleration."""

    counted = "loose_channels"

    def stated_count(self) -> int | None:
        """Number of loose sensors."""
        return None if self.loose_channels is None else len(self.loose_channels)

    def draw(self, of: Draws) -> Any:
        """Mounts of the loose sensors of a rig; None if all are firm."""
        loose = self.loose_channels
        if of.level != self.drawn_per:
            return self
        if loose is None:
            loose = tuple(
                channel for channel in range(of.channels) if of.u(f"probability.{channel}") < self.probability
            )
        return self.model_copy(update={"loose_channels": loose, "probability": 1.0}).drawn(of) if loose else None

    def disturb(self, signal: FloatArray, fs: float, rng: np.random.Generator) -> Disturbed:
        """Signal of sensors that resonate and rattle."""
        from gen.physics.rattle import rattling  # compiled: a recipe is read without numba

        loose, impacts, drawn = signal.copy(), 0, self.si()
        mounts = zip(self.loose_channels or (), drawn["frequency"], drawn["damping"], drawn["holding"], strict=True)
        for channel, frequency, damping, holding in mounts:
            held = through_mount(signal[channel], frequency, damping, fs)
            loose[channel], count = rattling(held, frequency, damping, holding, fs)
            impacts += count
        return loose, len(self.loose_channels or ()), impacts

    @staticmethod
    def compile() -> None:
        """Compile the rattling."""
        from gen.physics.rattle import compile_rattling

        compile_rattling()


def through_mount(signal: FloatArray, frequency: float, damping: float, fs: float) -> FloatArray:
    """Acceleration of a sensor on a mount with a resonance [Hz] and its damping ratio, without rattle, shape (time,) [m s-2].

    The record is continued backwards by its mirror image while the filter settles; the end of the response, which the circular
    convolution wraps around, falls into that time.
    """
    from scipy.fft import irfft, next_fast_len, rfft  # loads for half a second, and few recipes need it

    settling = math.ceil(DECAYED * fs / (2 * math.pi * damping * frequency))
    lead = signal[1 : min(settling, len(signal) - 1) + 1][::-1]
    n = next_fast_len(len(signal) + max(settling, len(lead)), real=True)
    ratio = np.arange(n // 2 + 1) * (fs / n) / frequency
    spectrum = rfft(np.concatenate([lead, signal]), n) * base_excited(ratio, damping)
    return irfft(spectrum, n)[len(lead) : len(lead) + len(signal)]
