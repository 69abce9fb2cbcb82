"""Bearing of each record behind its path, and background of its machine: noise, spectral lines, impulses and knocks.

Lines, knocks and modulations that are locked to the shaft have phases of the rig and turn with the true angle of the shaft. Noise, tones
and impulses at random times are drawn for each record.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.measurement.mixing import Lines, Parts, mix
from gen.measurement.rig import RigFilters
from gen.mechanisms.background.background import machine_sources_of
from gen.mechanisms.background.source import MachineSource, Vibration
from gen.mechanisms.mechanism import unusable_result
from gen.scenarios import Scenario
from gen.simulation.shaft import angles_of
from gen.simulation.simulate import Run, acceleration_of
from gen.simulation.timeline import timeline
from gen.simulation.truth import lines_of_faults

FloatArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]


def parts_of(runs: Sequence[Run], rigs: Sequence[RigFilters]) -> list[Parts]:
    """Bearings behind their paths, modulated by the shaft, and the backgrounds of their machines."""
    axis, n, bearings = timeline(runs[0].scenario.recipe), rigs[0].n, _behind_paths(runs, rigs)
    angles, lines, noises, others = [angles_of(run.motion) for run in runs], [], [], []
    for run, rig, turned in zip(runs, rigs, angles, strict=True):
        scenario, rng = run.scenario, run.scenario.stream("noise")
        # tones are not locked to the shaft: their phases are those of the record
        phases = 2 * np.pi * rng.random(len(rig.steps))
        lines.append(Lines(rig.modulations, rig.tones, rig.steps, phases, rig.tone_modulations))
        noises.append(_noise(scenario, rig, rng))
        others.append(_others(scenario, rig, turned))
    # transforms run side by side
    noises, others = irfft(np.stack(noises), n), np.stack(others)
    for run, noise in zip(runs, noises, strict=True):
        recipe, stream = run.scenario.recipe, run.scenario.stream
        if (recorded := recipe.background.recording) is not None:
            # what was recorded has passed path and sensor already
            noise[:, axis.kept] = recorded.segment(recipe, run.scenario.origin.specimen, stream(recorded.place))
    others = irfft(others, n) if others.any() else np.zeros_like(noises)
    parts = list[Parts]()
    for place, (run, rig, turned) in enumerate(zip(runs, rigs, angles, strict=True)):
        signals = np.concatenate([noises[place][None, :, : axis.returned], bearings[place][..., : axis.returned]])
        products = tuple(mix(signals, others[place], turned, lines[place], axis.kept).tolist())
        # only a record with a twin is judged by its lines
        orders, steady = lines_of_faults(run) if run.twin else (), run.scenario.speed_profile is None
        parts.append(Parts(signals[..., axis.kept], products, rig.impulse_lines, orders, turned[axis.kept], steady))
    return parts


def _behind_paths(runs: Sequence[Run], rigs: Sequence[RigFilters]) -> list[NDArray[Any]]:
    """Vibration of each bearing without its fault, then what the fault adds if that is known, shape (part, channel, time) [m s-2].

    The convolution is circular: its wrap-around falls into the lead ahead of the record, which is dropped. Filters may make signals longer.
    """
    signals = list[NDArray[Any]]()
    for run in runs:
        whole, sound = run.acceleration, run.twin and acceleration_of(run.twin)
        # the twin, and what the fault adds to it
        parts = whole[None] if sound is None else np.stack([sound, whole - sound])
        if run.scenario.recipe.background.recording is not None:
            # a recording has the vibration of its own healthy bearing
            parts = np.concatenate([np.zeros_like(parts[:1]), parts[1:]])
        signals.append(parts)
    # a path without resonances is a factor, and needs no transform
    resonant = [place for place, rig in enumerate(rigs) if rig.direct is None]
    if resonant:
        n, ends = rigs[0].n, np.cumsum([len(signals[place]) for place in resonant])[:-1]
        spectra = rfft(np.concatenate([signals[place] for place in resonant]), n)
        for spectrum, place in zip(np.split(spectra, ends), resonant, strict=True):
            spectrum *= rigs[place].bearing_paths
        for place, signal in zip(resonant, np.split(irfft(spectra, n), ends), strict=True):
            signals[place] = signal
    return [signal if rig.direct is None else signal * rig.direct for signal, rig in zip(signals, rigs, strict=True)]


def _noise(scenario: Scenario, rig: RigFilters, rng: np.random.Generator) -> ComplexArray:
    """Spectrum of noise of unit rms, shape (channel, frequency) [1]; a part of it is common to all channels."""
    (n_channels, n_lines), common = rig.paths.shape, math.sqrt(scenario.recipe.background.si()["coherence"])
    drawn = rng.standard_normal((n_channels, 2 * n_lines), dtype=np.float32)
    if common > 0 and n_channels > 1:
        drawn *= np.float32(math.sqrt(1 - common))
        drawn += np.float32(math.sqrt(common)) * rng.standard_normal(2 * n_lines, dtype=np.float32)
    return drawn.view(np.complex64) * rig.noise


def _others(scenario: Scenario, rig: RigFilters, angles: FloatArray) -> ComplexArray:
    """Spectrum behind the paths of the sources in the machine that are computed ahead of them, shape (channel, frequency) [1]."""
    spectrum = np.zeros(rig.paths.shape, np.complex64)
    hits = np.zeros(len(angles), np.float32)  # strengths of impulses at the samples where they start
    for source in machine_sources_of(scenario.recipe):
        stream = partial(scenario.stream, source.place)
        for vibration in _checked(source.vibrations(angles, rig.fs, stream), source, angles.shape):
            spectrum += rig.source_in_channels(vibration)
        source.add_impulses(hits, angles, rig.fs, stream)
    if hits.any():
        spectrum += rfft(hits, rig.n) * rig.impulse_paths
    return spectrum


def _checked(vibrations: Any, source: MachineSource, shape: tuple[int, ...]) -> list[Vibration]:
    """Vibrations of a source, which can be one of a plug-in; RacewayError unless they are arrays of finite numbers in this shape."""
    try:
        arrays = [np.asarray(vibration) for vibration in vibrations]
        usable = all(array.shape == shape and np.isfinite(array).all() for array in arrays)
    except (TypeError, ValueError):  # not a sequence, of unequal lengths, or not numbers
        usable, arrays = False, []
    if not usable:
        raise unusable_result(source, "vibrations", f"a list of arrays of {shape[0]} finite numbers each")
    return arrays
