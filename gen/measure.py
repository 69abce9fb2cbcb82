"""From the motion of the bodies to what a data-acquisition card stores.

response -> path -> shaft modulation -> machine background -> level -> converter. Healthy and faulty records take the same way: path and
background belong to the rig, and their random streams do not know the fault.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.physics.profile import turned
from gen.recipe import Recipe
from gen.scenarios import Background, Mode, Purpose, Rig, Scenario
from gen.simulate import LEAD_S, Response, lead_samples

FloatArray = NDArray[np.floating]
ComplexArray = NDArray[np.complex128]
LARGEST_COUNT = 32767


@dataclass(frozen=True)
class Measured:
    """Records as they are stored."""

    signal: NDArray[np.int16] | NDArray[np.float32]
    """Shape (record, channel, time): converter counts, or m s-2."""
    counts_per_unit: float | None
    """Counts per m s-2, None without a converter."""
    clipped: NDArray[np.int32]
    """Samples at the converter's limits, shape (record,)."""
    snr: FloatArray
    """Bearing over background, shape (record,) [dB]."""


def measure(response: Response, scenarios: list[Scenario], recipe: Recipe) -> Measured:
    """Turn a response into records.

    Parameters
    ----------
    response : Response
        Accelerations of the bodies, shape (record, channel, time).
    scenarios : list of Scenario
        What was simulated, in the same order.
    recipe : Recipe
        Gives sample rate, level and converter.
    """
    fs, lead = recipe.recording.sample_rate_hz, lead_samples(recipe)
    bearing = np.empty((len(scenarios), len(recipe.recording.channels), recipe.n_samples))
    background = np.empty_like(bearing)
    rigs: dict[int, _RigFilters] = {}
    for row, scenario in enumerate(scenarios):
        rig = scenario.rig
        if rig.number not in rigs:
            rigs[rig.number] = _RigFilters.of(rig, response.acceleration.shape[2], fs)
        rng = scenario.rng(Purpose.NOISE)
        turn = _shaft_angle(scenario, response.acceleration.shape[2], fs, rng)
        seen = _filtered(response.acceleration[row], rigs[rig.number].paths) * _shaft_modulation(rig, turn, rng)
        noise = machine_background(scenario, rigs[rig.number], turn, fs, len(seen), rng)
        bearing[row], background[row] = seen[:, lead:], noise[:, lead:]
    mixed, snr = _mix(bearing, background, scenarios)
    if recipe.recording.converter.kind == "float32":
        return Measured(mixed.astype(np.float32), None, np.zeros(len(mixed), np.int32), snr)
    counts_per_unit = LARGEST_COUNT / recipe.recording.converter.full_scale_m_s2
    counts = np.rint(np.nan_to_num(mixed) * counts_per_unit)
    clipped = (np.abs(counts) > LARGEST_COUNT).sum(axis=(1, 2)).astype(np.int32)
    return Measured(np.clip(counts, -LARGEST_COUNT, LARGEST_COUNT).astype(np.int16), counts_per_unit, clipped, snr)


@dataclass(frozen=True)
class _RigFilters:
    paths: ComplexArray
    """Path of each channel, shape (channel, frequency)."""
    colour: FloatArray
    """Amplitude spectrum of the noise, scaled to unit rms, shape (frequency,)."""

    @staticmethod
    def of(rig: Rig, n: int, fs: float) -> "_RigFilters":
        frequency = np.fft.rfftfreq(n, 1 / fs).astype(np.float64)
        paths = [own or rig.path for own in rig.own_paths]
        spectra = np.stack([path.direct + base_excited(path.modes, frequency) for path in paths])
        return _RigFilters(spectra, noise_colour(rig.background, frequency))


def base_excited(modes: tuple[Mode, ...], frequency: FloatArray) -> ComplexArray:
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
    falling = np.maximum(frequency, 10.0) ** (-background.slope / 2)
    falling *= np.abs(1 + base_excited(background.modes, frequency))
    falling[0] = 0.0
    power = falling**2 / np.mean(falling**2) + background.floor**2
    return np.sqrt(power / np.mean(power))


def modulation(depths: tuple[float, float], turn: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Gain that swings once and twice per shaft turn, shape (time,) [1]."""
    first, second = rng.uniform(0, 2 * np.pi, 2)
    if depths == (0.0, 0.0):
        return np.ones_like(turn)
    return 1 + depths[0] * np.cos(turn + first) + depths[1] * np.cos(2 * turn + second)


def _shaft_modulation(rig: Rig, turn: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Gain of each channel's path, shape (channel, time) [1]."""
    common = modulation(rig.path.modulation, turn, rng)
    return np.stack([common if own is None else modulation(own.modulation, turn, rng) for own in rig.own_paths])


def machine_background(
    scenario: Scenario,
    filters: _RigFilters,
    turn: FloatArray,
    fs: float,
    n_channels: int,
    rng: np.random.Generator,
) -> FloatArray:
    """Noise, shaft harmonics, tones, impulses and knocks of the rig, shape (channel, time), the noise at unit rms [1]."""
    background, n = scenario.rig.background, len(turn)
    noise = _filtered(rng.standard_normal((n_channels, n)), filters.colour)
    total = noise * modulation(background.modulation, turn, rng)
    lines = np.zeros((n_channels, n))
    time = np.arange(n) / fs
    for harmonic in background.harmonics:
        lines += np.sqrt(2) * harmonic.level * np.cos(harmonic.frequency * turn + rng.uniform(0, 2 * np.pi))
    for tone in background.tones:
        phase, swing = rng.uniform(0, 2 * np.pi, 2)
        gain = np.sqrt(2) * tone.level * (1 + tone.modulation * np.cos(turn + swing))
        lines += gain * np.cos(2 * np.pi * tone.frequency * time + phase)
    if background.impulses is not None:
        hits = rng.random(n) < background.impulses.frequency / fs
        lines += _ringing(hits * rng.standard_normal(n), background.impulses.level, filters)
    if background.knocks is not None:
        cycles = background.knocks.frequency * turn / (2 * np.pi) + rng.random()
        hits = np.diff(np.floor(cycles), prepend=np.floor(cycles[0])) > 0
        lines += _ringing(hits * (1 + 0.2 * rng.standard_normal(n)), background.knocks.level, filters)
    return total + lines


def _ringing(hits: FloatArray, level: float, filters: _RigFilters) -> FloatArray:
    """Impulses sent down the paths, the peak of a unit impulse at ``level``, shape (channel, time)."""
    unit = np.zeros(len(hits))
    unit[0] = 1.0
    peaks = np.abs(_filtered(unit, filters.paths)).max(axis=-1, keepdims=True)
    return _filtered(hits, filters.paths) * (level / peaks)


def _filtered(x: FloatArray, spectrum: ComplexArray | FloatArray) -> FloatArray:
    """``x`` times a spectrum, around the ends; the lead takes up what has died away within it."""
    return np.fft.irfft(np.fft.rfft(x) * spectrum, x.shape[-1])


def _shaft_angle(scenario: Scenario, n: int, fs: float, rng: np.random.Generator) -> FloatArray:
    """Shaft angle at the mean rate, or along its profile, from a random start, shape (time,) [rad]."""
    times = np.arange(n) / fs
    run = turned(scenario.record.speed_profile, times - LEAD_S)
    return 2 * np.pi * (scenario.record.conditions["shaft"] * run + rng.random())


def _mix(bearing: FloatArray, background: FloatArray, scenarios: list[Scenario]) -> tuple[FloatArray, FloatArray]:
    """Bearing over background at the drawn levels, and the ratio of the two [dB]."""
    heard = np.maximum(_rms(bearing), 1e-30)
    other = _rms(background)
    gain, noise = np.empty(len(scenarios)), np.empty(len(scenarios))
    for row, scenario in enumerate(scenarios):
        if scenario.record.snr is None or scenario.record.rms is None:
            gain[row], noise[row] = scenario.rig.gain, scenario.rig.gain * scenario.rig.background_rms
        else:
            ratio = 10 ** (scenario.record.snr / 20)
            whole = scenario.record.rms / np.hypot(1.0, ratio)
            gain[row], noise[row] = whole * ratio / heard[row], whole / other[row]
    snr = 20 * np.log10(gain * heard / np.maximum(noise * other, 1e-30))
    return gain[:, None, None] * bearing + noise[:, None, None] * background, snr


def _rms(x: FloatArray) -> FloatArray:
    return np.sqrt(np.mean(x**2, axis=(1, 2)))
