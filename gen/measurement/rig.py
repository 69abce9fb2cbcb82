"""Transfer paths and machine background of a rig, for records of one length."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from gen.drawing import Drawn
from gen.mechanisms.background.harmonics import motion_of_harmonics
from gen.mechanisms.background.noise import noise_factors
from gen.mechanisms.background.tones import motion_of_tones
from gen.mechanisms.path import parts_of_modulation, transmissibility
from gen.physics.kernel.decimate import pass_band
from gen.scenarios import Purpose, Rig, stream

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
ComplexArray = NDArray[np.complexfloating]

_SMALLEST_GAIN = 1e-6  # of a motion behind the paths; a line that all paths suppress stays out


@dataclass(frozen=True)
class RigFilters:
    """Transfer paths and machine background of a rig, ready for responses of one length."""

    n: int
    """Samples of a Fourier transform: at least as many as a response has."""
    fs: float
    """Sample rate [Hz]."""
    paths: ComplexArray
    """Transfer path of each channel, shape (channel, frequency)."""
    bearing_paths: ComplexArray
    """Path and sensor, for what has passed the anti-alias filter of the kernel, shape (channel, frequency)."""
    direct: Float32Array | None
    """The same where it does not depend on the frequency, shape (channel, 1), else None."""
    chain: ComplexArray
    """Response of the measuring chain to what is computed at the sample rate: sensor and anti-alias filter, shape (frequency,)."""
    noise: Float32Array
    """Factors that turn complex numbers of unit variance into the spectrum of noise of unit rms, shape (frequency,)."""
    modulations: ComplexArray
    """Modulation once and twice per turn, of the noise and of the path of each channel, shape (1 + channel, 2)."""
    motion: ComplexArray
    """Motion of the machine along each channel, at the harmonics of the shaft and then at the tones, shape (channel, line)."""
    amplitudes: FloatArray
    """Of the same lines, shape (line,)."""
    steps: FloatArray
    """Angle per sample of each tone, shape (tone,) [rad]."""
    tone_modulations: ComplexArray
    """Modulation of each tone by the shaft, shape (tone,)."""
    background: Drawn
    """As drawn for the rig."""
    knock_phase: float
    """Phase of the knocks [rad]."""
    impulse_paths: ComplexArray
    """Path and chain, scaled so that an impulse has a peak of 1 behind each, shape (channel, frequency); unscaled without impulses."""
    impulse_lines: Float32Array
    """Rms of the lines of impulses at random times in the squared envelope of a response, by frequency, shape (channel, frequency) [1]."""

    def source_in_channels(self, source: FloatArray) -> ComplexArray:
        """Spectrum of a source in the machine behind path and chain, shape (channel, frequency), of ``source``, shape (time,) [1].

        Its rms over all channels behind the paths is the same as ahead of them.
        """
        spectrum = rfft(source.astype(np.float32), self.n)
        behind = spectrum * self.paths
        power = float(np.mean(np.abs(behind) ** 2))
        behind *= self.chain * (math.sqrt(float(np.mean(np.abs(spectrum) ** 2)) / power) if power > 0 else 0.0)
        return behind

    def in_channels(self, frequencies: FloatArray) -> ComplexArray:
        """Complex amplitudes of the lines behind the paths at ``frequencies`` [Hz], shape (channel, line).

        The motion and the paths divide each line among the channels; its rms over them is its amplitude.
        """
        at = np.clip(frequencies, 0.0, self.fs / 2) * (self.n / self.fs)
        below = np.minimum(at.astype(int), self.paths.shape[1] - 2)
        share = at - below
        behind_paths = self.motion * (self.paths[:, below] * (1 - share) + self.paths[:, below + 1] * share)
        chain = self.chain[below] * (1 - share) + self.chain[below + 1] * share
        rms = np.sqrt(np.mean(np.abs(behind_paths) ** 2, axis=0))
        return behind_paths * (chain * self.amplitudes / np.maximum(rms, _SMALLEST_GAIN))


def rig_filters(rig: Rig, length: int, fs: float, seed: int) -> RigFilters:
    """Transfer paths and background of a rig, for responses of ``length`` samples.

    Everything that is locked to the shaft has a phase that belongs to the rig, drawn from its own stream of ``seed``.
    """
    n, background = next_fast_len(length, real=True), rig.background
    frequency = np.arange(n // 2 + 1) * (fs / n)
    own = [path or rig.path for path in rig.own_paths]
    sensor = high_pass(rig.high_pass, frequency)
    chain = sensor * pass_band(frequency * (2 / fs))
    paths = np.stack([path["direct"] + transmissibility(path["modes"], frequency) for path in own])
    impulse_paths, impulses = paths * chain, background["impulses"]
    if impulses or background["knocks"]:
        impulse_paths /= np.abs(irfft(impulse_paths, n)).max(axis=1, keepdims=True)
    # An impulse of strength ``a`` raises all lines by ``a^2`` times its energy; the mean of ``a^4`` is 3 for a normal distribution.
    of_impulses = math.sqrt(3 * impulses["frequency"] * length / fs) * impulses["level"] ** 2 if impulses else 0.0
    of_modulations, of_harmonics, of_tones, of_knocks = stream(seed, rig.number, 0, 0, Purpose.PHASES).spawn(4)
    directions = np.array([channel.angle for channel in rig.channels])
    harmonics, harmonic_motion = motion_of_harmonics(background["harmonics"] or (), directions, of_harmonics)
    tones, tone_motion = motion_of_tones(background["tones"] or (), fs, directions, of_tones)
    direct = None if rig.high_pass > 0 or any(path["modes"] for path in own) else [[path["direct"]] for path in own]
    return RigFilters(
        n=n,
        fs=fs,
        paths=paths.astype(np.complex64),
        bearing_paths=(paths * sensor).astype(np.complex64),
        direct=None if direct is None else np.array(direct, np.float32),
        chain=chain,
        noise=noise_factors(background, frequency, np.abs(chain), n),
        modulations=_modulations(rig, of_modulations),
        motion=np.concatenate([harmonic_motion, tone_motion], axis=1),
        amplitudes=np.concatenate([harmonics, tones[:, 1]]),
        steps=tones[:, 0].copy(),
        tone_modulations=tones[:, 2] + 1j * tones[:, 3],
        background=background,
        knock_phase=2 * math.pi * of_knocks.random(),
        impulse_paths=impulse_paths.astype(np.complex64),
        impulse_lines=np.float32(of_impulses) * np.abs(impulse_paths.astype(np.complex64)) ** 2,
    )


def _modulations(rig: Rig, rng: np.random.Generator) -> ComplexArray:
    """Modulations of the noise and of the path of each channel, shape (1 + channel, 2); channels on the common path share one."""
    of_noise, of_path, *of_own = rng.random((2 + len(rig.own_paths), 2))
    rows = [parts_of_modulation(rig.background["modulation"], of_noise)]
    for own, turns in zip(rig.own_paths, of_own, strict=True):
        path, turns = (rig.path, of_path) if own is None else (own, turns)
        rows.append(parts_of_modulation(path["modulation"], turns))
    return np.array(rows).view(np.complex128)


def high_pass(corner: float, frequency: FloatArray) -> ComplexArray:
    """Response of a sensor that does not measure down to 0 Hz, a high pass of first order, shape (frequency,) [1].

    ``corner`` is where it has lost 3 dB [Hz]; 0 for none. With ``u = f / corner`` the response is ``i u / (1 + i u)``.
    """
    if corner == 0:
        return np.ones(len(frequency), complex)
    return 1j * frequency / (corner + 1j * frequency)
