"""Background of the records of a rig: noise, spectral lines, impulses and knocks of the machine.

Lines, knocks and modulations that are locked to the shaft have phases of the rig and turn with the true angle of the shaft. Noise, tones
and impulses at random times are drawn for each record.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.measurement.mixing import Lines
from gen.measurement.rig import RigFilters
from gen.mechanisms.background.impulses import add_impulses
from gen.mechanisms.background.knocks import add_knocks
from gen.physics.elementary import power
from gen.physics.profile import share_at
from gen.scenarios import Scenario
from gen.simulation.timeline import Timeline

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
NO_SIGNAL, _NO_GROWTH = np.empty((0, 0), np.float32), np.empty(0)


def noise_of(filters: Sequence[RigFilters], n_channels: int, rngs: Sequence[np.random.Generator]) -> Float32Array:
    """Noise of unit rms, drawn as its spectrum, shape (record, channel, time) [1]; a part of it is common to all channels."""
    n = filters[0].n
    drawn = np.empty((len(filters), n_channels, 2 * (n // 2 + 1)), np.float32)
    for row, row_filters, rng in zip(drawn, filters, rngs, strict=True):
        rng.standard_normal(out=row, dtype=np.float32)
        if row_filters.common_noise > 0 and n_channels > 1:
            row *= np.float32(math.sqrt(1 - row_filters.common_noise))
            row += np.float32(math.sqrt(row_filters.common_noise)) * rng.standard_normal(row.shape[1], dtype=np.float32)
    spectra = drawn.view(np.complex64)
    for spectrum, row_filters in zip(spectra, filters, strict=True):
        spectrum *= row_filters.noise
    return irfft(spectra, n)


def lines_of(filters: RigFilters, scenario: Scenario, rng: np.random.Generator, axis: Timeline) -> Lines:
    """Lines and modulations of a record: only tones, which are not locked to the shaft, have phases of their own in each record."""
    record, steps = scenario.record, filters.tones[:, 0]
    n_orders = len(filters.harmonics)
    phases = 2 * np.pi * rng.random(len(steps))
    rates = record.conditions.shaft_rate * np.arange(1, n_orders + 1)
    motion = np.concatenate([filters.harmonic_motion, filters.tone_motion], axis=1)
    amplitudes = np.concatenate([filters.harmonics, filters.tones[:, 1]])
    lines = filters.in_channels(motion, amplitudes, np.concatenate([rates, steps * axis.fs / (2 * np.pi)]))
    parts = np.stack([lines.real, lines.imag], axis=2)
    growth = _NO_GROWTH
    exponent = filters.background["growth"]
    if record.speed_profile is not None and exponent > 0 and n_orders:
        growth = power(share_at(record.speed_profile, axis.response_times()), exponent)
    return Lines(
        modulations=filters.modulations,
        harmonics=parts[:, :n_orders],
        growth=growth,
        tones=np.stack([steps, phases, filters.tones[:, 2], filters.tones[:, 3]], axis=1),
        tone_parts=parts[:, n_orders:],
    )


def impulses_of(
    filters: Sequence[RigFilters], angles: Sequence[FloatArray], rngs: Sequence[np.random.Generator]
) -> list[Float32Array]:
    """Impulses at random times, and knocks locked to the shaft, behind the paths: shape (channel, time) each, or (0, 0) for none [1]."""
    signals = [NO_SIGNAL] * len(filters)
    rows = [row for row, some in enumerate(filters) if some.background["impulses"] or some.background["knocks"]]
    if rows:
        hits = np.stack([_hits(filters[row], angles[row], rngs[row]) for row in rows])
        paths = np.stack([filters[row].impulse_paths for row in rows])
        spectra = rfft(hits, filters[0].n)[:, None] * paths
        for row, filtered in zip(rows, irfft(spectra, filters[0].n), strict=True):
            signals[row] = filtered
    return signals


def _hits(filters: RigFilters, angles: FloatArray, rng: np.random.Generator) -> Float32Array:
    """Strength of impulses and knocks at the samples where they start, shape (time,) [1]."""
    hits, background = np.zeros(len(angles), np.float32), filters.background
    if background["impulses"]:
        add_impulses(hits, background["impulses"], filters.fs, rng)
    if background["knocks"]:
        add_knocks(hits, background["knocks"], filters.knock_phase, angles, rng)
    return hits
