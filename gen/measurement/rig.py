"""Transfer paths and machine background of a rig, for records of one length."""

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
class RigFilters:
    """Transfer paths and machine background of a rig, ready for responses of one length."""

    n: int
    """Samples of a Fourier transform: at least as many as a response has."""
    paths: NDArray[np.complex64]
    """Transfer path of each channel, shape (channel, frequency)."""
    direct: Float32Array | None
    """The same where no path has resonances, shape (channel, 1), else None."""
    noise: Float32Array
    """Factors that turn complex numbers of unit variance into the spectrum of noise of unit rms, shape (frequency,)."""
    harmonics: FloatArray
    """Amplitude of each harmonic of the shaft, shape (order,)."""
    tones: FloatArray
    """Angle per sample [rad], amplitude and depth of modulation of each tone, shape (tone, 3)."""
    modulations: FloatArray
    """Depth of modulation once and twice per turn, of the noise and of the path of each channel, shape (1 + channel, 2)."""
    modulation_numbers: NDArray[np.int_]
    """Index of the modulation that each of them uses; channels on the common path share one."""
    impulses: tuple[float, float]
    """Expected number in a response, and level."""
    knocks: tuple[float, float]
    """Number in a turn of the shaft, and level."""
    impulse_paths: NDArray[np.complex64]
    """The paths, scaled so that an impulse has a peak of 1 behind each, shape (channel, frequency); unscaled without impulses."""


def rig_filters(rig: Rig, length: int, fs: float) -> RigFilters:
    """Transfer paths and background of a rig, for responses of ``length`` samples."""
    n, background = next_fast_len(length, real=True), rig.background
    frequency = np.arange(n // 2 + 1) * (fs / n)
    own = [path or rig.path for path in rig.own_paths]
    paths = np.stack([path.direct + base_excited(path.modes, frequency) for path in own]).astype(np.complex64)
    impulses, knocks = background.impulses, background.knocks
    impulse_paths = paths
    if impulses is not None or knocks is not None:
        impulse_paths = paths / np.abs(irfft(paths, n)).max(axis=1, keepdims=True)
    modulations = [background.modulation, *(path.modulation for path in own)]
    return RigFilters(
        n=n,
        paths=paths,
        direct=None if any(path.modes for path in own) else np.array([[path.direct] for path in own], np.float32),
        noise=_noise_factors(background, frequency, n),
        harmonics=_harmonics(background),
        tones=_tones(background, fs),
        modulations=np.array([[modulation.once, modulation.twice] for modulation in modulations]),
        modulation_numbers=np.array(
            [0, *(1 if path is None else place for place, path in enumerate(rig.own_paths, 2))]
        ),
        impulses=(0.0, 0.0) if impulses is None else (impulses.frequency * length / fs, impulses.level),
        knocks=(0.0, 0.0) if knocks is None else (knocks.frequency, knocks.level),
        impulse_paths=impulse_paths,
    )


def _noise_factors(background: Background, frequency: FloatArray, n: int) -> Float32Array:
    factors = noise_spectrum(background, frequency) * math.sqrt(n / 2)
    # the spectrum is real at 0 Hz, and at the Nyquist frequency of an even n: one number has all of the power there
    factors[:1] *= math.sqrt(2)
    factors[n - n // 2 :] *= math.sqrt(2)
    return factors.astype(np.float32)


def _harmonics(background: Background) -> FloatArray:
    levels = np.zeros(max((int(line.frequency) for line in background.harmonics), default=0))
    for line in background.harmonics:
        levels[int(line.frequency) - 1] = math.sqrt(2) * line.level
    return levels


def _tones(background: Background, fs: float) -> FloatArray:
    root = math.sqrt(2)
    tones = [(2 * math.pi * tone.frequency / fs, root * tone.level, tone.modulation) for tone in background.tones]
    return np.array(tones).reshape(-1, 3)


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


def noise_spectrum(background: Background, frequency: FloatArray) -> FloatArray:
    """Amplitude spectrum of the noise of a machine, with unit mean power, shape (frequency,) [1].

    Its PSD is a white floor plus ``f^-slope``, constant below 10 Hz, times the resonances.
    """
    falling = power(np.maximum(frequency, 10.0), -background.slope / 2)
    falling *= np.abs(1 + base_excited(background.modes, frequency))
    falling[0] = 0.0
    density = falling**2 / np.mean(falling**2) + background.floor**2
    return np.sqrt(density / np.mean(density))
