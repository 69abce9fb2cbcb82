"""Transfer paths and machine background of a rig, for records of one length."""

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from gen.mechanisms.background.noise import noise_factors
from gen.mechanisms.background.tones import tones_of_machine
from gen.mechanisms.path import modulation_by_shaft, transmissibility
from gen.physics.kernel.decimate import pass_band
from gen.recipe import Recipe
from gen.scenarios import Scenario
from gen.simulation.timeline import timeline
from gen.support.units import decibel_to_ratio

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
    directions: FloatArray
    """Of the channels, counter-clockwise from the horizontal, shape (channel,) [rad]."""
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
    tones: ComplexArray
    """Complex amplitude of each tone in each channel, shape (channel, tone)."""
    steps: FloatArray
    """Angle per sample of each tone, shape (tone,) [rad]."""
    tone_modulations: ComplexArray
    """Modulation of each tone by the shaft, shape (tone,)."""
    impulse_paths: ComplexArray
    """Path and chain, scaled so that an impulse has a peak of 1 behind each, shape (channel, frequency)."""
    impulse_lines: Float32Array
    """Rms of the lines of impulses at random times in the squared envelope of a response, by frequency, shape (channel, frequency) [1]."""

    def source_in_channels(self, source: NDArray[np.inexact]) -> ComplexArray:
        """Spectrum of a source in the machine behind path and chain, shape (channel, frequency), of ``source``, shape (time,) [1].

        A complex source is a motion, of which each channel measures the part along its direction. Its rms over all channels behind the
        paths is the same as ahead of them, where it is the mean over all directions.
        """
        motion = np.iscomplexobj(source)
        along = (source * np.exp(-1j * self.directions)[:, None]).real if motion else source[None]
        behind = rfft(along.astype(np.float32), self.n) * self.paths
        # both are means over the samples of the source; a direction has half the power of a motion
        power = 2 * float(np.sum(np.mean(np.abs(behind) ** 2, axis=0))) / (self.n * len(source))
        ahead = float(np.mean(np.abs(source) ** 2)) / (1 + motion)
        behind *= self.chain * (math.sqrt(ahead / power) if power > 0 else 0.0)
        return behind


def rig_filters(scenario: Scenario) -> RigFilters:
    """Transfer paths and background of the rig of a record. Everything that is locked to the shaft has a phase that belongs to the rig."""
    recipe, axis, phases = scenario.recipe, timeline(scenario.recipe), functools.partial(scenario.stream, level="rig")
    background, channels, fs = recipe.background, recipe.recording.channels, axis.fs
    # a length that is fast to transform
    n = next_fast_len(axis.returned, real=True)
    frequency = np.arange(n // 2 + 1) * (fs / n)
    own = [channel.path or recipe.path for channel in channels]
    corner = recipe.recording.si()["high_pass"]
    sensor = high_pass(corner, frequency)
    chain = sensor * pass_band(frequency * (2 / fs))
    # each channel has a path, of its own or common to all
    paths = np.stack([path.si()["direct"] + transmissibility(path.modes, frequency) for path in own])
    # an impulse keeps its height, whatever the resonances of the path
    impulse_paths, of_impulses = paths * chain, 0.0
    impulse_paths /= np.maximum(np.abs(irfft(impulse_paths, n)).max(axis=1, keepdims=True), _SMALLEST_GAIN)
    if background.impulses is not None:
        # An impulse of strength ``a`` raises all lines by ``a^2`` times its energy; the mean of ``a^4`` is 3 for a normal distribution.
        impulses = background.impulses.si()
        of_impulses = math.sqrt(3 * impulses["rate"] * axis.returned / fs) * decibel_to_ratio(impulses["level"]) ** 2
    directions = np.array([channel.si()["angle"] for channel in channels])
    amplitudes, motion, frequencies, tone_modulations = tones_of_machine(background, directions, phases)
    # motion and paths divide each tone among the channels; its rms over them is its amplitude
    at = np.clip(frequencies, 0.0, fs / 2)
    behind = motion * np.array([np.interp(at, frequency, path) for path in paths])
    rms = np.sqrt(np.mean(np.abs(behind) ** 2, axis=0))
    tones = behind * (np.interp(at, frequency, chain) * amplitudes / np.maximum(rms, _SMALLEST_GAIN))
    direct = None if corner > 0 or any(path.modes for path in own) else [[path.si()["direct"]] for path in own]
    return RigFilters(
        n=n,
        fs=fs,
        directions=directions,
        paths=paths.astype(np.complex64),
        bearing_paths=(paths * sensor).astype(np.complex64),
        direct=None if direct is None else np.array(direct, np.float32),
        chain=chain,
        noise=noise_factors(background, frequency, np.abs(chain), n),
        modulations=_modulations(recipe, phases("phases of modulation")),
        tones=tones,
        steps=2 * math.pi / fs * frequencies,
        tone_modulations=tone_modulations,
        impulse_paths=impulse_paths.astype(np.complex64),
        impulse_lines=np.float32(of_impulses) * np.abs(impulse_paths.astype(np.complex64)) ** 2,
    )


def _modulations(recipe: Recipe, rng: np.random.Generator) -> ComplexArray:
    """Modulations of the noise and of the path of each channel, shape (1 + channel, 2); channels on the common path share one."""
    own = [channel.path for channel in recipe.recording.channels]
    of_noise, of_path, *of_own = rng.random((2 + len(own), 2))
    modulated = [(path or recipe.path, turns if path else of_path) for path, turns in zip(own, of_own, strict=True)]
    parts = [(recipe.background, of_noise), *modulated]
    return np.array([modulation_by_shaft(part.modulation, turns) for part, turns in parts])


def high_pass(corner: float, frequency: FloatArray) -> ComplexArray:
    """Response of a sensor that does not measure down to 0 Hz, a high pass of first order, shape (frequency,) [1].

    ``corner`` is where it has lost 3 dB [Hz]; 0 for none. With ``u = f / corner`` the response is ``i u / (1 + i u)``.
    """
    if corner == 0:
        return np.ones(len(frequency), complex)
    return 1j * frequency / (corner + 1j * frequency)
