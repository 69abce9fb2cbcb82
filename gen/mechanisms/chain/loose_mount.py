"""Sensors that are not held firmly."""

import math
from typing import Any

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Drawn, Draws, Probability, within
from gen.mechanisms.chain.sensor_fault import FloatArray, Found, SensorFault
from gen.mechanisms.mechanism import is_flat
from gen.physics.resonance import base_excited

DECAYED = 7.0  # time constants after which a filter has settled to 1e-3


class LooseMount(SensorFault):
    """A sensor that is not held firmly: mount and sensor resonate, and the sensor lifts off and strikes the machine (rattle)."""

    place, rig_stream, noise_stream = "loose_mount", 0, 4
    labels = (
        Variable("loose_mount", "i4", "1", "latent", "channels whose sensor is mounted loosely"),
        Variable("rattle", "i4", "1", "latent", "impacts of loose sensors on the machine, all channels together"),
    )

    probability: Probability
    """Share of the sensors that are mounted loosely; drawn per rig for each channel."""
    frequency_hz: Distribution = within(50, 20_000)
    """Resonance of the sensor on its mount: the looser the mount, the lower it is."""
    damping_percent: Distribution = within(0.1, 50)
    """Damping ratio of that resonance."""
    holding_m_s2: Distribution = within(0, 1e6, open_low=True)
    """Force that holds the sensor over its mass; the sensor lifts off where it would have to follow with more than this acceleration."""

    def draw(self, draws: Draws, channels: int) -> Any:
        """Mount of each channel, None for a firm one."""
        mounts = tuple(one.section(self) if one.is_present(self) else None for one in draws.spawn(channels))
        return mounts if any(mounts) else None

    @staticmethod
    def has_form(drawn: Any, channels: int) -> bool:
        """One mount, or None, for each channel."""
        return isinstance(drawn, tuple) and len(drawn) == channels and all(one is None or is_flat(one) for one in drawn)

    @staticmethod
    def disturb(drawn: Any, signal: FloatArray, fs: float, rng: np.random.Generator) -> tuple[FloatArray, Found]:  # noqa: ARG004
        """Signal of sensors that resonate and rattle."""
        from gen.physics.rattle import rattling  # compiled: a recipe is read without numba

        loose, impacts = signal.copy(), 0
        for channel, mount in enumerate(drawn):
            if isinstance(mount, dict):
                held = through_mount(signal[channel], mount, fs)
                loose[channel], count = rattling(held, mount["frequency"], mount["damping"], mount["holding"], fs)
                impacts += count
        return loose, {"loose_mount": sum(map(bool, drawn)), "rattle": impacts}

    @staticmethod
    def compile() -> None:
        """Compile the rattling."""
        from gen.physics.rattle import compile_rattling

        compile_rattling()


def through_mount(signal: FloatArray, mount: Drawn, fs: float) -> FloatArray:
    """Acceleration of a sensor on a compliant mount, without rattle, shape (time,) [m s-2].

    The record is continued backwards by its mirror image while the filter settles; the end of the response, which the circular
    convolution wraps around, falls into that time.
    """
    from scipy.fft import irfft, next_fast_len, rfft  # loads for half a second, and few recipes need it

    settling = math.ceil(DECAYED * fs / (2 * math.pi * mount["damping"] * mount["frequency"]))
    lead = signal[1 : min(settling, len(signal) - 1) + 1][::-1]
    n = next_fast_len(len(signal) + max(settling, len(lead)), real=True)
    ratio = np.arange(n // 2 + 1) * (fs / n) / mount["frequency"]
    spectrum = rfft(np.concatenate([lead, signal]), n) * base_excited(ratio, mount["damping"])
    return irfft(spectrum, n)[len(lead) : len(lead) + len(signal)]
