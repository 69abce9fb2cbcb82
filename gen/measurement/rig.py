"""What a rig makes of its bearings, and what it adds to them: path, colour of the noise, lines, ringing and modulation."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len

from gen.physics.elementary import power
from gen.scenarios import Background, Mode, Rig

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]


@dataclass(frozen=True)
class Sound:
    """What a rig makes of its bearings, and adds to them."""

    n: int
    """Samples of a transform: those of a response, and as many more as make it fast."""
    paths: NDArray[np.complex64]
    """Path of each channel, shape (channel, frequency)."""
    direct: Float32Array | None
    """The same where no path has resonances, shape (channel, 1)."""
    colour: Float32Array
    """What turns complex numbers of unit variance into noise of unit rms, shape (frequency,)."""
    levels: FloatArray
    """Amplitude of each harmonic of the shaft, shape (order,)."""
    tones: FloatArray
    """Angle per sample [rad], amplitude and depth of modulation of each tone, shape (tone, 3)."""
    depths: FloatArray
    """Modulation once and twice per turn of the noise and of each channel's path, shape (1 + channel, 2)."""
    swings_with: NDArray[np.int_]
    """Number of the modulation of each of them: channels on the common path swing together."""
    impulses: tuple[float, float]
    """Number in a response, and level."""
    knocks: tuple[float, float]
    """Number in a turn of the shaft, and level."""
    struck: NDArray[np.complex64]
    """The paths, scaled so that an impulse has a peak of one behind each, shape (channel, frequency); unscaled without impulses."""

    @staticmethod
    def of(rig: Rig, length: int, fs: float) -> "Sound":
        """Sound of a rig, for responses of ``length`` samples."""
        n, background = next_fast_len(length, real=True), rig.background
        frequency = np.arange(n // 2 + 1) * (fs / n)
        ways = [own or rig.path for own in rig.own_paths]
        paths = np.stack([way.direct + base_excited(way.modes, frequency) for way in ways]).astype(np.complex64)
        colour = noise_colour(background, frequency) * math.sqrt(n / 2)
        colour[:1] *= math.sqrt(2)  # real, so all of its power is in one number
        colour[n - n // 2 :] *= math.sqrt(2)  # of an even n
        levels = np.zeros(max((int(line.frequency) for line in background.harmonics), default=0))
        for line in background.harmonics:
            levels[int(line.frequency) - 1] = math.sqrt(2) * line.level
        tones = [
            (2 * math.pi * tone.frequency / fs, math.sqrt(2) * tone.level, tone.modulation) for tone in background.tones
        ]
        impulses, knocks = background.impulses, background.knocks
        struck = paths
        if impulses is not None or knocks is not None:
            struck = paths / np.abs(irfft(paths, n)).max(axis=1, keepdims=True)
        return Sound(
            n,
            paths,
            None if any(way.modes for way in ways) else np.array([[way.direct] for way in ways], np.float32),
            colour.astype(np.float32),
            levels,
            np.array(tones).reshape(-1, 3),
            np.array([background.modulation, *(way.modulation for way in ways)]),
            np.array([0, *(1 if own is None else place for place, own in enumerate(rig.own_paths, 2))]),
            (0.0, 0.0) if impulses is None else (impulses.frequency * length / fs, impulses.level),
            (0.0, 0.0) if knocks is None else (knocks.frequency, knocks.level),
            struck,
        )


def base_excited(modes: tuple[Mode, ...], frequency: FloatArray) -> NDArray[np.complex128]:
    """Sum of the transmissibilities of base-excited resonances, times their gains, shape (frequency,) [1].

    ``(1 + 2 i zeta r) / (1 - r^2 + 2 i zeta r)`` with ``r = f / f_mode``; S. S. Rao, Mechanical Vibrations, section 3.6.
    """
    total = np.zeros(len(frequency), complex)
    for mode in modes:
        ratio = frequency / mode.frequency
        loss = 2j * mode.damping * ratio
        total += mode.gain * (1 + loss) / (1 - ratio**2 + loss)
    return total


def noise_colour(background: Background, frequency: FloatArray) -> FloatArray:
    """Amplitude spectrum of the machine's noise with unit mean power, shape (frequency,) [1].

    The PSD falls with ``f^-slope`` above 10 Hz, times the resonances, over a white floor.
    """
    falling = power(np.maximum(frequency, 10.0), -background.slope / 2)
    falling *= np.abs(1 + base_excited(background.modes, frequency))
    falling[0] = 0.0
    density = falling**2 / np.mean(falling**2) + background.floor**2
    return np.sqrt(density / np.mean(density))
