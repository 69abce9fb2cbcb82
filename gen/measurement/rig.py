"""Transfer paths and machine background of a rig, for records of one length."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from gen.physics.elementary import power
from gen.physics.kernel.decimate import pass_band
from gen.physics.resonance import base_excited
from gen.scenarios import Background, Mode, Purpose, Rig, ShaftModulation, stream

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]

_FLATTEST = 0.8  # orbit at a harmonic: the shaft never moves along a straight line
_SMALLEST_GAIN = 1e-6  # of a motion behind the paths; a line that all paths suppress stays out


@dataclass(frozen=True)
class RigFilters:
    """Transfer paths and machine background of a rig, ready for responses of one length."""

    n: int
    """Samples of a Fourier transform: at least as many as a response has."""
    fs: float
    """Sample rate [Hz]."""
    paths: NDArray[np.complex64]
    """Transfer path of each channel, shape (channel, frequency)."""
    bearing_paths: NDArray[np.complex64]
    """Path and sensor, for what has passed the anti-alias filter of the kernel, shape (channel, frequency)."""
    direct: Float32Array | None
    """The same where it does not depend on the frequency, shape (channel, 1), else None."""
    chain: NDArray[np.complex128]
    """Response of the measuring chain to what is computed at the sample rate: sensor and anti-alias filter, shape (frequency,)."""
    noise: Float32Array
    """Factors that turn complex numbers of unit variance into the spectrum of noise of unit rms, shape (frequency,)."""
    common_noise: float
    """Share of the power of the noise that all channels have in common [1]."""
    modulations: FloatArray
    """Parts of the modulation once and twice per turn, of the noise and of the path of each channel, shape (1 + channel, 4)."""
    harmonics: FloatArray
    """Amplitude of each harmonic of the shaft, shape (order,)."""
    harmonic_motion: NDArray[np.complex128]
    """Motion of the machine at each harmonic along each channel, shape (channel, order)."""
    growth: float
    """Exponent of the growth of the harmonics with the speed [1]."""
    tones: FloatArray
    """Angle per sample [rad], amplitude, and parts of the modulation by the shaft, of each tone, shape (tone, 4)."""
    tone_motion: NDArray[np.complex128]
    """Motion of the machine at each tone along each channel, shape (channel, tone)."""
    impulses: tuple[float, float]
    """Expected number in a response, and level."""
    knocks: tuple[float, float, float]
    """Number in a turn of the shaft, level, and phase [rad]."""
    impulse_paths: NDArray[np.complex64]
    """Path and chain, scaled so that an impulse has a peak of 1 behind each, shape (channel, frequency); unscaled without impulses."""

    @property
    def impulse_lines(self) -> Float32Array:
        """Rms of the lines of impulses in the squared envelope of a response, by frequency, shape (channel, frequency) [1].

        An impulse of strength ``a`` raises all lines by ``a^2`` times its energy; the mean of ``a^4`` is 3 for a normal distribution.
        """
        number, level = self.impulses
        return np.float32(math.sqrt(3 * number) * level**2) * np.abs(self.impulse_paths) ** 2

    def source_in_channels(self, source: FloatArray) -> Float32Array:
        """Signal of a source in the machine behind path and chain of each channel, shape (channel, time), of ``source``, shape (time,) [1].

        Its rms over all channels behind the paths is that ahead of them. The convolution is circular, as that of the bearing: what it
        wraps around falls into the lead ahead of the record.
        """
        spectrum = rfft(source.astype(np.float32), self.n)
        behind = spectrum * self.paths
        power = float(np.mean(np.abs(behind) ** 2))
        behind *= self.chain * (math.sqrt(float(np.mean(np.abs(spectrum) ** 2)) / power) if power > 0 else 0.0)
        return irfft(behind, self.n)[:, : len(source)].astype(np.float32)

    def in_channels(
        self, motion: NDArray[np.complex128], amplitudes: FloatArray, frequencies: FloatArray
    ) -> NDArray[np.complex128]:
        """Complex amplitudes of lines behind the paths, shape (channel, line); their rms over the channels is that of ``amplitudes``.

        ``motion``, shape (channel, line), and the paths at ``frequencies`` [Hz] divide each line among the channels.
        """
        if not len(amplitudes):
            return motion
        at = np.clip(frequencies, 0.0, self.fs / 2) * (self.n / self.fs)
        below = np.minimum(at.astype(int), self.paths.shape[1] - 2)
        share = at - below
        behind_paths = motion * (self.paths[:, below] * (1 - share) + self.paths[:, below + 1] * share)
        chain = self.chain[below] * (1 - share) + self.chain[below + 1] * share
        return behind_paths * (
            chain * amplitudes / np.maximum(np.sqrt(np.mean(np.abs(behind_paths) ** 2, axis=0)), _SMALLEST_GAIN)
        )


def rig_filters(rig: Rig, length: int, fs: float, seed: int) -> RigFilters:
    """Transfer paths and background of a rig, for responses of ``length`` samples.

    Everything that is locked to the shaft has a phase that belongs to the rig, drawn from its own stream of ``seed``.
    """
    n, background = next_fast_len(length, real=True), rig.background
    frequency = np.arange(n // 2 + 1) * (fs / n)
    own = [path or rig.path for path in rig.own_paths]
    sensor = high_pass(rig.high_pass, frequency)
    chain = sensor * pass_band(frequency * (2 / fs))
    paths = np.stack([path.direct + base_transmissibility(path.modes, frequency) for path in own])
    impulses, knocks = background.impulses, background.knocks
    impulse_paths = paths * chain
    if impulses is not None or knocks is not None:
        impulse_paths /= np.abs(irfft(impulse_paths, n)).max(axis=1, keepdims=True)
    of_modulations, of_harmonics, of_tones, of_knocks = stream(seed, rig.number, 0, 0, Purpose.PHASES).spawn(4)
    directions = np.array([channel.angle for channel in rig.channels])
    harmonics, harmonic_motion = _harmonics(background, directions, of_harmonics)
    tones, tone_motion = _tones(background, fs, directions, of_tones)
    return RigFilters(
        n=n,
        fs=fs,
        paths=paths.astype(np.complex64),
        bearing_paths=(paths * sensor).astype(np.complex64),
        direct=None
        if rig.high_pass > 0 or any(path.modes for path in own)
        else np.array([[path.direct] for path in own], np.float32),
        chain=chain,
        noise=_noise_factors(background, frequency, np.abs(chain), n),
        common_noise=math.sqrt(background.coherence),
        modulations=_modulations(rig, of_modulations),
        harmonics=harmonics,
        harmonic_motion=harmonic_motion,
        growth=background.growth,
        tones=tones,
        tone_motion=tone_motion,
        impulses=(0.0, 0.0) if impulses is None else (impulses.frequency * length / fs, impulses.level),
        knocks=(0.0, 0.0, 0.0)
        if knocks is None
        else (knocks.frequency, knocks.level, 2 * math.pi * of_knocks.random()),
        impulse_paths=impulse_paths.astype(np.complex64),
    )


def _noise_factors(background: Background, frequency: FloatArray, chain: FloatArray, n: int) -> Float32Array:
    factors = noise_spectrum(background, frequency) * chain
    factors *= math.sqrt(n / 2) / np.sqrt(np.mean(np.square(factors)))
    # the spectrum is real at 0 Hz, and at the Nyquist frequency of an even n: one number has all of the power there
    factors[:1] *= math.sqrt(2)
    factors[n - n // 2 :] *= math.sqrt(2)
    return factors.astype(np.float32)


def _modulations(rig: Rig, rng: np.random.Generator) -> FloatArray:
    """Parts of all modulations, shape (1 + channel, 4); channels on the common path share one."""
    of_noise, of_path, *of_own = 2 * np.pi * rng.random((2 + len(rig.own_paths), 2))
    rows = [_parts(rig.background.modulation, of_noise)]
    for path, phases in zip(rig.own_paths, of_own, strict=True):
        rows.append(_parts(rig.path.modulation, of_path) if path is None else _parts(path.modulation, phases))
    return np.array(rows)


def _parts(modulation: ShaftModulation, phases: FloatArray) -> FloatArray:
    """Parts of a modulation once per turn, then of that twice per turn, shape (4,)."""
    depths = np.array([modulation.once, modulation.twice])
    return np.stack([depths * np.cos(phases), depths * np.sin(phases)], axis=1).ravel()


def _harmonics(
    background: Background, directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, NDArray[np.complex128]]:
    """Amplitudes and motions of the harmonics; the first is in phase with the unbalance, which points along the mark of the shaft."""
    levels = np.zeros(max((int(line.frequency) for line in background.harmonics), default=0))
    for line in background.harmonics:
        levels[int(line.frequency) - 1] = math.sqrt(2) * line.level
    forward, backward, flatness = rng.random((3, len(levels)))
    forward[:1] = 0.0
    return levels, along(directions, 2 * np.pi * forward, 2 * np.pi * backward, _FLATTEST * flatness)


def _tones(
    background: Background, fs: float, directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, NDArray[np.complex128]]:
    root, count = math.sqrt(2), len(background.tones)
    forward, backward, flatness, phases = rng.random((4, count))
    depths = np.array([tone.modulation for tone in background.tones])
    steps = np.array([2 * math.pi * tone.frequency / fs for tone in background.tones])
    levels = np.array([root * tone.level for tone in background.tones])
    tones = np.stack([steps, levels, depths * np.cos(2 * np.pi * phases), depths * np.sin(2 * np.pi * phases)], axis=1)
    return tones, along(directions, 2 * np.pi * forward, 2 * np.pi * backward, flatness)


def along(
    directions: FloatArray, forward: FloatArray, backward: FloatArray, flatness: FloatArray
) -> NDArray[np.complex128]:
    """Complex amplitudes of elliptical motions along ``directions`` [rad], shape (direction, line) [1].

    An ellipse is the sum of a vector that turns with the shaft and one that turns against it, with the phases ``forward`` and
    ``backward`` [rad]; ``flatness`` is the ratio of their lengths: 0 for a circle, 1 for a straight line. Each has shape (line,). See
    A. Muszynska, Rotordynamics, CRC Press, 2005.
    """
    turned: NDArray[np.complex128] = np.exp(-1j * directions)[:, None]
    return np.exp(1j * forward) * turned + flatness * np.exp(1j * backward) * np.conj(turned)


def base_transmissibility(modes: tuple[Mode, ...], frequency: FloatArray) -> NDArray[np.complex128]:
    """Sum of the transmissibilities of base-excited resonances, times their gains, shape (frequency,) [1]."""
    total = np.zeros(len(frequency), complex)
    for mode in modes:
        total += base_excited(frequency / mode.frequency, mode.damping, mode.gain)
    return total


def high_pass(corner: float, frequency: FloatArray) -> NDArray[np.complex128]:
    """Response of a sensor that does not measure down to 0 Hz, a high pass of first order, shape (frequency,) [1].

    ``corner`` is where it has lost 3 dB [Hz]; 0 for none. With ``u = f / corner`` the response is ``i u / (1 + i u)``.
    """
    if corner == 0:
        return np.ones(len(frequency), complex)
    return 1j * frequency / (corner + 1j * frequency)


def noise_spectrum(background: Background, frequency: FloatArray) -> FloatArray:
    """Amplitude spectrum of the noise of a machine, with unit mean power, shape (frequency,) [1].

    Its PSD is a white floor plus ``f^-slope``, constant below 10 Hz, times the resonances.
    """
    falling = power(np.maximum(frequency, 10.0), -background.slope / 2)
    falling *= np.abs(1 + base_transmissibility(background.modes, frequency))
    falling[0] = 0.0
    density = falling**2 / np.mean(falling**2) + background.floor**2
    return np.sqrt(density / np.mean(density))
