"""From the motion of the bodies to what a data-acquisition card stores.

response -> path -> shaft modulation -> machine background -> level -> converter. Healthy and faulty records take the same way: path and
background belong to the rig, and their random streams do not know the fault. From the response on all is in single precision, which
leaves an error of 1e-7 of the record's largest value: a three-hundredth of a count of the converter at full scale.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.measurement.mixing import Lines, Shaft, mix
from gen.measurement.rig import Sound
from gen.physics.elementary import decibels
from gen.physics.profile import turned
from gen.recipe import Recipe
from gen.scenarios import Purpose, Scenario
from gen.simulation.simulate import LEAD_S, Response, lead_samples

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
LARGEST_COUNT = 32767
SILENCE = 1e-30  # m s-2, below which an rms is nothing
_ROWS = 8  # records times channels at a time: enough for transforms side by side, few enough for the second-level cache
_NO_RINGING, _NO_ANGLES = np.empty((0, 0), np.float32), np.empty(0)


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
    """Bearing over background, or over the rounding noise of the converter if that is larger, shape (record,) [dB]. NaN for a record
    without a bearing, without a background to compare it with, or without a sample that is not zero."""


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
    recording, length = recipe.recording, response.acceleration.shape[2]
    shape = len(scenarios), len(recording.channels), recipe.n_samples
    rigs = {scenario.rig.number: scenario.rig for scenario in scenarios}
    sounds = {number: Sound.of(rig, length, recording.sample_rate_hz) for number, rig in rigs.items()}
    heard = [sounds[scenario.rig.number] for scenario in scenarios]
    converter = recording.converter
    counts_per_unit = None if converter.kind == "float32" else LARGEST_COUNT / converter.full_scale_m_s2
    signal: Any = np.empty(shape, np.float32 if counts_per_unit is None else np.int16)
    clipped, snr = np.zeros(shape[0], np.int32), np.empty(shape[0])
    rounding = (
        0.0 if counts_per_unit is None else 1 / (counts_per_unit * math.sqrt(12))
    )  # rms of an error within half a count
    several = max(1, _ROWS // shape[1])
    for first in range(0, shape[0], several):
        some = slice(first, first + several)
        mixed, rms = _mixed(response.acceleration[some], scenarios[some], heard[some], recipe)
        if counts_per_unit is not None:
            np.rint(np.multiply(mixed, np.float32(counts_per_unit), out=mixed), out=mixed)
            clipped[some] = np.count_nonzero(np.abs(mixed) > LARGEST_COUNT, axis=(1, 2))
            np.clip(mixed, -LARGEST_COUNT, LARGEST_COUNT, out=mixed)
            mixed[np.isnan(rms).any(axis=0)] = 0.0  # what diverged is left out, but has no count
        signal[some] = mixed
        snr[some] = np.where(signal[some].any(axis=(1, 2)), _ratio(rms[0], np.maximum(rms[1], rounding)), np.nan)
    return Measured(signal, counts_per_unit, clipped, snr)


def compile_mixing(scenario: Scenario, recipe: Recipe) -> None:
    """Compile what puts records together, or fetch it from numba's cache on disk."""
    silence = np.zeros((1, len(recipe.recording.channels), lead_samples(recipe) + recipe.n_samples), np.float32)
    measure(Response(silence, np.ones(1, np.int64), np.zeros(1), {}, [None]), [scenario], recipe)


def _mixed(
    acceleration: Float32Array, scenarios: Sequence[Scenario], sounds: Sequence[Sound], recipe: Recipe
) -> tuple[Float32Array, FloatArray]:
    """Bearing and background at the drawn levels, shape (record, channel, time), and the rms of either, shape (2, record) [m s-2]."""
    lead, (n_records, n_channels, length) = lead_samples(recipe), acceleration.shape
    kept = slice(lead, lead + recipe.n_samples)
    rngs = [scenario.rng(Purpose.NOISE) for scenario in scenarios]
    phases = [_phases(sound, rng) for sound, rng in zip(sounds, rngs, strict=True)]
    shafts = [
        _shaft(scenario, length, recipe.recording.sample_rate_hz, start)
        for scenario, (_, start, _) in zip(scenarios, phases, strict=True)
    ]
    bearing, background = _through_paths(acceleration, sounds), _noise(sounds, n_channels, rngs)
    knocks = [knock for _, _, knock in phases]
    ringing = _ringing(sounds, shafts, knocks, length, rngs)
    rms, gains = np.empty((2, n_records)), np.empty((2, n_records))
    for row, (lines, _, _) in enumerate(phases):
        rms[:, row] = mix(bearing[row], background[row], ringing[row], shafts[row], lines, kept.start, kept.stop)
        gains[:, row] = _gains(scenarios[row], *np.maximum(rms[:, row], SILENCE))
    gain, noise = gains.astype(np.float32)[:, :, None, None]
    mixed = gain * bearing[..., kept]
    mixed += np.multiply(noise, background[..., kept], out=background[..., kept])
    return mixed, rms * gains


def _ratio(bearing: FloatArray, background: FloatArray) -> FloatArray:
    """Ratio of two rms values, NaN if either is nothing [dB]."""
    known = (bearing > SILENCE) & (background > SILENCE) & np.isfinite(bearing) & np.isfinite(background)
    return np.where(known, decibels(np.where(known, bearing, 1.0) / np.where(known, background, 1.0)), np.nan)


def _through_paths(acceleration: Float32Array, sounds: Sequence[Sound]) -> Float32Array:
    """Accelerations behind the paths, shape (record, channel, time); the lead takes up what runs around the ends [m s-2]."""
    heard = acceleration.copy()
    resonant = [row for row, sound in enumerate(sounds) if sound.direct is None]
    for row, sound in enumerate(sounds):
        if sound.direct is not None:
            heard[row] *= sound.direct
    if resonant:
        spectra = rfft(heard[resonant], sounds[0].n)
        for spectrum, row in zip(spectra, resonant, strict=True):
            spectrum *= sounds[row].paths
        heard[resonant] = irfft(spectra, sounds[0].n)[..., : heard.shape[2]]
    return heard


def _noise(sounds: Sequence[Sound], n_channels: int, rngs: Sequence[np.random.Generator]) -> Float32Array:
    """Noise of unit rms, drawn as its spectrum, shape (record, channel, time) [1]."""
    n = sounds[0].n
    drawn = np.empty((len(sounds), n_channels, 2 * (n // 2 + 1)), np.float32)
    for row, rng in zip(drawn, rngs, strict=True):
        rng.standard_normal(out=row, dtype=np.float32)
    spectra = drawn.view(np.complex64)
    for spectrum, sound in zip(spectra, sounds, strict=True):
        spectrum *= sound.colour
    return irfft(spectra, n)


def _phases(sound: Sound, rng: np.random.Generator) -> tuple[Lines, float, float]:
    """Lines and modulations with the phases they have in this record; angle of the shaft and of the knocks at the start [rad]."""
    n_swings, n_harmonics = 2 * (len(sound.depths) + 1), len(sound.levels)
    drawn = 2 * np.pi * rng.random(2 + n_swings + n_harmonics + 2 * len(sound.tones))
    swings, harmonics, tones = np.split(drawn[2:], [n_swings, n_swings + n_harmonics])
    lines = Lines(
        np.concatenate([sound.depths, swings.reshape(-1, 2)[sound.swings_with]], axis=1),
        np.stack([sound.levels, harmonics], axis=1),
        np.concatenate([sound.tones, tones.reshape(-1, 2)], axis=1),
    )
    return lines, drawn[0], drawn[1]


def _shaft(scenario: Scenario, length: int, fs: float, start: float) -> Shaft:
    """Angle of the shaft at the mean rate, or along its profile, from the start of the response on."""
    step = 2 * math.pi * scenario.record.conditions["shaft"] / fs
    profile = scenario.record.speed_profile
    if profile is None:
        return Shaft(start, step, _NO_ANGLES)
    return Shaft(start, step, start + step * fs * turned(profile, np.arange(length) / fs - LEAD_S))


def _ringing(
    sounds: Sequence[Sound],
    shafts: Sequence[Shaft],
    knocks: Sequence[float],
    length: int,
    rngs: Sequence[np.random.Generator],
) -> list[Float32Array]:
    """Impulses at random times and knocks that come with the shaft, behind the paths, each of shape (channel, time) or (0, 0) [1]."""
    found = [_NO_RINGING] * len(sounds)
    heard = [row for row, sound in enumerate(sounds) if sound.impulses[0] > 0 or sound.knocks[0] > 0]
    if heard:
        hits = np.stack([_hits(sounds[row], shafts[row], knocks[row], length, rngs[row]) for row in heard])
        spectra = rfft(hits, sounds[0].n)[:, None] * np.stack([sounds[row].struck for row in heard])
        for row, ringing in zip(heard, irfft(spectra, sounds[0].n), strict=True):
            found[row] = ringing
    return found


def _hits(sound: Sound, shaft: Shaft, knock: float, length: int, rng: np.random.Generator) -> Float32Array:
    """Strengths of impulses and knocks at the samples on which they fall, shape (time,) [1]."""
    hits = np.zeros(length, np.float32)
    number, level = sound.impulses
    times = rng.integers(length, size=rng.poisson(number))
    np.add.at(hits, times, level * rng.standard_normal(len(times), dtype=np.float32))
    orders, level = sound.knocks
    if orders > 0:
        angles = shaft.angles if len(shaft.angles) else shaft.start + shaft.step * np.arange(length)
        times = np.flatnonzero(np.diff(np.floor((orders * angles + knock) / (2 * np.pi))) > 0) + 1
        hits[times] += level * (1 + 0.2 * rng.standard_normal(len(times), dtype=np.float32))
    return hits


def _gains(scenario: Scenario, heard: float, other: float) -> tuple[float, float]:
    """Gains of bearing and background [1]."""
    rig, record = scenario.rig, scenario.record
    if record.snr is None or record.rms is None:
        return rig.gain, rig.gain * rig.background_rms
    ratio = 10 ** (record.snr / 20)
    whole = record.rms / math.hypot(1.0, ratio)
    return whole * ratio / heard, whole / other
