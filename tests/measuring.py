"""Accelerations and rigs for the laws of the measurement, on responses that need no simulation."""

from dataclasses import replace

import numpy as np

from gen.measurement.measure import measure
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.timeline import timeline

FS = 12_000.0
FLOAT = {"recording.converter": {"kind": "float32"}}


def path(direct, modes=(), once=0.0, twice=0.0):
    return {"direct": direct, "modes": tuple(modes), "modulation": {"once": once, "twice": twice}}


def mode(frequency, damping, gain):
    return {"frequency": frequency, "damping": damping, "gain": gain}


def tone(frequency, level, modulation=0.0):
    return {"frequency": float(frequency), "level": level, "modulation": modulation}


def quiet(**sources):
    """A drawn background without a floor to speak of, with some sources."""
    return {
        "slope": 0.0, "floor": 1e-6, "modes": (), "modulation": {"once": 0.0, "twice": 0.0}, "coherence": 0.0, "growth": 0.0,
        "harmonics": None, "tones": None, "impulses": None, "knocks": None,
    } | sources  # fmt: skip


QUIET = quiet()


def response(recipe, n_records, wave):
    """``wave(time)`` as the acceleration of every record and channel, shape (record, channel, time)."""
    n = timeline(settings_of(recipe)).lead + recipe.n_samples
    signal = np.broadcast_to(wave(np.arange(n) / FS), (n_records, len(recipe.recording.channels), n))
    return signal.copy()


def silence(recipe, n_records):
    return response(recipe, n_records, np.zeros_like)


def hiss(recipe, n_records):
    return response(recipe, n_records, lambda time: np.random.default_rng(0).standard_normal(len(time)))


def rms(x):
    return np.sqrt(np.mean(np.asarray(x, dtype=float) ** 2, axis=(1, 2)))


def with_rig(scenarios, **changes):
    return [replace(scenario, rig=replace(scenario.rig, **changes)) for scenario in scenarios]


def background_of(recipe, background, n_records=1, **of_rig):
    """Signals of a machine with a background and a bearing at rest, shape (record, channel, time), and their scenarios."""
    drawn = draw_scenarios(recipe, 0, n_records)
    scenarios = with_rig(drawn, **{"background": background, "background_rms": 1.0, "gain": 1.0} | of_rig)
    return measure(silence(recipe, n_records), scenarios).signal.astype(float), scenarios
