"""Background of the records of a rig: noise, spectral lines, impulses and knocks of the machine.

Lines, knocks and modulations that are locked to the shaft have phases of the rig and turn with the true angle of the shaft. Noise, tones
and impulses at random times are drawn for each record.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.measurement.mixing import Lines, Parts, Products, mix
from gen.measurement.path import Vibration
from gen.mechanisms.background.section import locked_of
from gen.physics.elementary import power
from gen.physics.profile import share_at
from gen.simulation.timeline import Timeline

FloatArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]


def with_background(vibrations: Sequence[Vibration], axis: Timeline) -> list[Parts]:
    """Bearings behind their paths, modulated by the shaft, and the backgrounds of their machines."""
    n, parts = vibrations[0].filters.n, []
    rngs = [one.scenario.stream("noise") for one in vibrations]
    lines = [_lines(one, rng, axis) for one, rng in zip(vibrations, rngs, strict=True)]
    noises = irfft(np.stack([_noise(one, rng) for one, rng in zip(vibrations, rngs, strict=True)]), n)
    others = np.stack([_others(one, rng) for one, rng in zip(vibrations, rngs, strict=True)])
    others = irfft(others, n) if others.any() else np.zeros_like(noises)
    for one, noise, other, of_record in zip(vibrations, noises, others, lines, strict=True):
        signals = np.concatenate([noise[None, :, : axis.returned], one.bearing[..., : axis.returned]])
        products = Products(*mix(signals, other, one.angles, of_record, axis.kept))
        steady, kept = one.scenario.speed_profile is None, signals[..., axis.kept]
        parts.append(Parts(kept, products, one.filters.impulse_lines, one.orders, one.angles[axis.kept], steady))
    return parts


def _lines(one: Vibration, rng: np.random.Generator, axis: Timeline) -> Lines:
    """Lines and modulations of a record: only tones, which are not locked to the shaft, have phases of their own in each record."""
    profile, filters = one.scenario.speed_profile, one.filters
    n_orders = len(filters.amplitudes) - len(filters.steps)
    rates = one.scenario.conditions["shaft_rate"] * np.arange(1, n_orders + 1)
    phases = 2 * np.pi * rng.random(len(filters.steps))
    amplitudes = filters.in_channels(np.concatenate([rates, filters.steps * axis.fs / (2 * np.pi)]))
    growth, harmonics = np.empty(0), filters.background.harmonics
    if profile is not None and harmonics is not None and (exponent := harmonics.si()["growth"]) > 0:
        growth = power(share_at(profile, axis.response_times()), exponent)
    return Lines(filters.modulations, amplitudes, growth, filters.steps, phases, filters.tone_modulations)


def _noise(one: Vibration, rng: np.random.Generator) -> ComplexArray:
    """Spectrum of noise of unit rms, shape (channel, frequency) [1]; a part of it is common to all channels."""
    (n_channels, n_lines), common = one.filters.paths.shape, math.sqrt(one.filters.background.si()["coherence"])
    drawn = rng.standard_normal((n_channels, 2 * n_lines), dtype=np.float32)
    if common > 0 and n_channels > 1:
        drawn *= np.float32(math.sqrt(1 - common))
        drawn += np.float32(math.sqrt(common)) * rng.standard_normal(2 * n_lines, dtype=np.float32)
    return drawn.view(np.complex64) * one.filters.noise


def _others(one: Vibration, rng: np.random.Generator) -> ComplexArray:
    """Spectrum behind the paths of impulses at random times and of sources locked to the shaft, shape (channel, frequency) [1]."""
    filters, spectrum = one.filters, np.zeros(one.filters.paths.shape, np.complex64)
    impulses, knocks = filters.background.impulses, filters.background.knocks
    if impulses or knocks:
        hits = np.zeros(len(one.angles), np.float32)  # strength at the samples where they start
        if impulses is not None:
            impulses.add_to(hits, filters.fs, rng)
        if knocks is not None:
            knocks.add_to(hits, filters.knock_phase, one.angles, rng)
        spectrum += rfft(hits, filters.n) * filters.impulse_paths
    for source in locked_of(one.scenario.recipe):
        streams = one.scenario.stream(source.place, "rig"), one.scenario.stream(source.place)
        for vibration in source.vibrations(one.angles, filters.fs, *streams):
            spectrum += filters.source_in_channels(vibration)
    return spectrum
