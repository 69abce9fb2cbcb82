"""From the motion of the bodies to the samples that a data-acquisition card stores.

response -> transfer path -> modulation by the shaft -> machine background -> level -> converter. Healthy and faulty records are measured
alike: path and background belong to the rig, and their random streams do not depend on the fault. All of it is in single precision. Its
error is 1e-7 of the largest value of a record: a three-hundredth of a count of the converter at full scale.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.measurement.mixing import Lines, ShaftAngle, mix
from gen.measurement.rig import RigFilters, rig_filters
from gen.physics.elementary import decibels
from gen.physics.profile import integrated_share
from gen.recipe import Recipe
from gen.scenarios import Purpose, Scenario
from gen.simulation.timeline import Timeline, timeline

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
LARGEST_COUNT = 32767
SILENCE = 1e-30  # m s-2; a smaller rms counts as no signal
_ROWS = 8  # records times channels per pass: transforms run side by side, and their arrays fit the second-level cache
_NO_IMPULSES, _NO_ANGLES = np.empty((0, 0), np.float32), np.empty(0)


@dataclass(frozen=True)
class Measured:
    """Records as they are stored."""

    signal: NDArray[np.int16] | NDArray[np.float32]
    """Shape (record, channel, time): converter counts, or m s-2."""
    counts_per_unit: float | None
    """Counts per m s-2, None without a converter."""
    clipped: NDArray[np.int32]
    """Samples at the limits of the converter, shape (record,)."""
    snr: FloatArray
    """Rms of the bearing over that of the background, or over the rounding noise of the converter if that is larger, shape (record,) [dB].
    NaN for a record without a bearing signal, without a background, or with no sample but zeros."""


def measure(acceleration: Float32Array, scenarios: list[Scenario], recipe: Recipe) -> Measured:
    """Turn accelerations of the bodies into records.

    Parameters
    ----------
    acceleration : array, shape (record, channel, time)
        Acceleration that each channel measures, from the lead ahead of the record on [m s-2].
    scenarios : list of Scenario
        The scenarios that were simulated, in the same order.
    recipe : Recipe
        Gives sample rate, level and converter.
    """
    recording, axis = recipe.recording, timeline(recipe)
    shape = len(scenarios), len(recording.channels), axis.record
    rigs = {scenario.rig.number: scenario.rig for scenario in scenarios}
    of_rig = {number: rig_filters(rig, axis.returned, axis.fs) for number, rig in rigs.items()}
    filters = [of_rig[scenario.rig.number] for scenario in scenarios]
    converter = recording.converter
    counts_per_unit = None if converter.kind == "float32" else LARGEST_COUNT / converter.full_scale_m_s2
    signal: Any = np.empty(shape, np.float32 if counts_per_unit is None else np.int16)
    clipped, snr = np.zeros(shape[0], np.int32), np.empty(shape[0])
    # rms of an error that is uniform within half a count
    rounding = 0.0 if counts_per_unit is None else 1 / (counts_per_unit * math.sqrt(12))
    several = max(1, _ROWS // shape[1])
    for first in range(0, shape[0], several):
        some = slice(first, first + several)
        mixed, rms = _mixed(acceleration[some], scenarios[some], filters[some], axis)
        if counts_per_unit is not None:
            np.rint(np.multiply(mixed, np.float32(counts_per_unit), out=mixed), out=mixed)
            clipped[some] = np.count_nonzero(np.abs(mixed) > LARGEST_COUNT, axis=(1, 2))
            np.clip(mixed, -LARGEST_COUNT, LARGEST_COUNT, out=mixed)
            mixed[np.isnan(rms).any(axis=0)] = 0.0  # a record that diverged is left out, but NaN has no count
        signal[some] = mixed
        snr[some] = np.where(signal[some].any(axis=(1, 2)), _ratio(rms[0], np.maximum(rms[1], rounding)), np.nan)
    return Measured(signal, counts_per_unit, clipped, snr)


def compile_mixing(scenario: Scenario, recipe: Recipe) -> None:
    """Compile the mixing of records, or fetch it from numba's cache on disk."""
    silence = np.zeros((1, len(recipe.recording.channels), timeline(recipe).returned), np.float32)
    measure(silence, [scenario], recipe)


def _mixed(
    acceleration: Float32Array, scenarios: Sequence[Scenario], filters: Sequence[RigFilters], axis: Timeline
) -> tuple[Float32Array, FloatArray]:
    """Bearing plus background at the drawn levels, shape (record, channel, time), and the rms of each, shape (2, record) [m s-2]."""
    n_records, n_channels, _ = acceleration.shape
    rngs = [scenario.rng(Purpose.NOISE) for scenario in scenarios]
    phases = [_phases(found, rng) for found, rng in zip(filters, rngs, strict=True)]
    shafts = [_shaft_angle(scenario, axis, start) for scenario, (_, start, _) in zip(scenarios, phases, strict=True)]
    bearing, background = _through_paths(acceleration, filters), _noise(filters, n_channels, rngs)
    impulses = _impulses(filters, shafts, [knock for _, _, knock in phases], axis.returned, rngs)
    rms, gains = np.empty((2, n_records)), np.empty((2, n_records))
    for row, (lines, _, _) in enumerate(phases):
        kept = axis.kept
        rms[:, row] = mix(bearing[row], background[row], impulses[row], shafts[row], lines, kept.start, kept.stop)
        gains[:, row] = _gains(scenarios[row], *np.maximum(rms[:, row], SILENCE))
    of_bearing, of_background = gains.astype(np.float32)[:, :, None, None]
    mixed = of_bearing * bearing[..., axis.kept]
    mixed += np.multiply(of_background, background[..., axis.kept], out=background[..., axis.kept])
    return mixed, rms * gains


def _ratio(bearing: FloatArray, background: FloatArray) -> FloatArray:
    """Ratio of two rms values, NaN if either is below SILENCE or not finite [dB]."""
    known = (bearing > SILENCE) & (background > SILENCE) & np.isfinite(bearing) & np.isfinite(background)
    return np.where(known, decibels(np.where(known, bearing, 1.0) / np.where(known, background, 1.0)), np.nan)


def _through_paths(acceleration: Float32Array, filters: Sequence[RigFilters]) -> Float32Array:
    """Accelerations behind the transfer paths, shape (record, channel, time) [m s-2].

    The convolution is circular; its wrap-around falls into the lead, which is dropped.
    """
    filtered = acceleration.copy()
    resonant = [row for row, found in enumerate(filters) if found.direct is None]
    for row, found in enumerate(filters):
        if found.direct is not None:
            filtered[row] *= found.direct
    if resonant:
        spectra = rfft(filtered[resonant], filters[0].n)
        for spectrum, row in zip(spectra, resonant, strict=True):
            spectrum *= filters[row].paths
        filtered[resonant] = irfft(spectra, filters[0].n)[..., : filtered.shape[2]]
    return filtered


def _noise(filters: Sequence[RigFilters], n_channels: int, rngs: Sequence[np.random.Generator]) -> Float32Array:
    """Noise of unit rms, drawn as its spectrum, shape (record, channel, time) [1]."""
    n = filters[0].n
    drawn = np.empty((len(filters), n_channels, 2 * (n // 2 + 1)), np.float32)
    for row, rng in zip(drawn, rngs, strict=True):
        rng.standard_normal(out=row, dtype=np.float32)
    spectra = drawn.view(np.complex64)
    for spectrum, found in zip(spectra, filters, strict=True):
        spectrum *= found.noise
    return irfft(spectra, n)


def _phases(filters: RigFilters, rng: np.random.Generator) -> tuple[Lines, float, float]:
    """Lines and modulations with the phases drawn for this record; angle of the shaft and of the knocks at the start [rad]."""
    n_modulations, n_harmonics = 2 * (len(filters.modulations) + 1), len(filters.harmonics)
    drawn = 2 * np.pi * rng.random(2 + n_modulations + n_harmonics + 2 * len(filters.tones))
    modulations, harmonics, tones = np.split(drawn[2:], [n_modulations, n_modulations + n_harmonics])
    own = modulations.reshape(-1, 2)[filters.modulation_numbers]
    lines = Lines(
        np.concatenate([filters.modulations, own], axis=1),
        np.stack([filters.harmonics, harmonics], axis=1),
        np.concatenate([filters.tones, tones.reshape(-1, 2)], axis=1),
    )
    return lines, drawn[0], drawn[1]


def _shaft_angle(scenario: Scenario, axis: Timeline, start: float) -> ShaftAngle:
    """Angle of the shaft from the start of the response on, at the mean rate or along its profile."""
    step = 2 * math.pi * scenario.record.conditions["shaft"] / axis.fs
    profile = scenario.record.speed_profile
    if profile is None:
        return ShaftAngle(start, step, _NO_ANGLES)
    return ShaftAngle(start, step, start + step * axis.fs * integrated_share(profile, axis.response_times()))


def _impulses(
    filters: Sequence[RigFilters],
    shafts: Sequence[ShaftAngle],
    knocks: Sequence[float],
    length: int,
    rngs: Sequence[np.random.Generator],
) -> list[Float32Array]:
    """Impulses at random times, and knocks locked to the shaft, behind the paths: shape (channel, time) each, or (0, 0) for none [1]."""
    found = [_NO_IMPULSES] * len(filters)
    rows = [row for row, some in enumerate(filters) if some.impulses[0] > 0 or some.knocks[0] > 0]
    if rows:
        hits = np.stack([_hits(filters[row], shafts[row], knocks[row], length, rngs[row]) for row in rows])
        paths = np.stack([filters[row].impulse_paths for row in rows])
        spectra = rfft(hits, filters[0].n)[:, None] * paths
        for row, filtered in zip(rows, irfft(spectra, filters[0].n), strict=True):
            found[row] = filtered
    return found


def _hits(filters: RigFilters, shaft: ShaftAngle, knock: float, length: int, rng: np.random.Generator) -> Float32Array:
    """Strength of impulses and knocks at the samples where they start, shape (time,) [1]."""
    hits = np.zeros(length, np.float32)
    number, level = filters.impulses
    times = rng.integers(length, size=rng.poisson(number))
    np.add.at(hits, times, level * rng.standard_normal(len(times), dtype=np.float32))
    orders, level = filters.knocks
    if orders > 0:
        angles = shaft.angles if len(shaft.angles) else shaft.start + shaft.step * np.arange(length)
        times = np.flatnonzero(np.diff(np.floor((orders * angles + knock) / (2 * np.pi))) > 0) + 1
        hits[times] += level * (1 + 0.2 * rng.standard_normal(len(times), dtype=np.float32))
    return hits


def _gains(scenario: Scenario, bearing: float, background: float) -> tuple[float, float]:
    """Gains of bearing and background, given the rms of each [1]."""
    rig, record = scenario.rig, scenario.record
    if record.snr is None or record.rms is None:
        return rig.gain, rig.gain * rig.background_rms
    ratio = 10 ** (record.snr / 20)
    whole = record.rms / math.hypot(1.0, ratio)
    return whole * ratio / bearing, whole / background
