"""Drawn sections, and machines and bearings that need no simulation, for the laws of mechanisms and measurement."""

from types import SimpleNamespace

import numpy as np

from gen.drawing import Combination, Draws
from gen.measurement import measure as measuring
from gen.scenarios import draw_scenarios
from gen.simulation.timeline import timeline
from tests.responses import runs_of

FS = 12_000.0
FLOAT = {"recording.converter": {"kind": "float32"}}


def measure(accelerations, scenarios, healthy=None, **keys):
    """Measured records of bodies with these accelerations, side by side."""
    return side_by_side(measuring.measure(runs_of(scenarios, accelerations, healthy), **keys))


def side_by_side(records):
    """Signals, shape (record, channel, time), and other values of measured records, shape (record,)."""
    names = ("signal", "clipped", "snr", "fault_snr", "fault_share", "detectable")
    columns = {name: np.array([getattr(record, name) for record in records]) for name in names}
    scenarios = [record.scenario for record in records]
    return SimpleNamespace(
        **columns, scenarios=scenarios, counts_per_unit=measuring.counts_per_unit(scenarios[0].recipe)
    )


def drawn(section, **keys):
    """A section of a recipe as one rig, specimen and record have it; one with a probability is there."""
    there = {"probability": 1} if "probability" in section.model_fields else {}
    given = section.model_validate(there | keys)
    for level in ("rig", "specimen", "record"):
        given = given.draw(Draws(0, level, 0, Combination(0), []))
    return given


def lines(levels, **others):
    """Keys of lines with some levels [dB] and other keys that are the same for all of them."""
    return {"count": len(levels), "level_db": [*levels]} | {key: [value] * len(levels) for key, value in others.items()}


def quiet(**keys):
    """Section ``background`` of white noise and nothing else, with some keys; its sources are there."""
    sources = {
        key: {"probability": 1, **value} for key, value in keys.items() if isinstance(value, dict) and key != "modes"
    }
    return {"background": {"floor_db": -120, **keys, **sources}}


def physical(background=1.0, gain=1.0):
    """Section ``level`` with this rms of the background [m s-2]."""
    return {"level": {"kind": "physical", "background_m_s2": background, "gain": gain}}


def direct(gain=1.0, **keys):
    """Section ``path`` with a direct part, and resonances or a modulation among the keys alone."""
    return {"path": {"direct": gain, **keys}}


def response(recipe, n_records, wave):
    """``wave(time)`` as the acceleration of every record and channel, shape (record, channel, time)."""
    axis = timeline(recipe)
    signal = np.broadcast_to(
        wave(np.arange(axis.returned) / axis.fs), (n_records, len(recipe.recording.channels), axis.returned)
    )
    return signal.copy()


def silence(recipe, n_records):
    return response(recipe, n_records, np.zeros_like)


def hiss(recipe, n_records):
    return response(recipe, n_records, lambda time: np.random.default_rng(0).standard_normal(len(time)))


def rms(x):
    return np.sqrt(np.mean(np.asarray(x, dtype=float) ** 2, axis=(1, 2)))


def background_of(recipe, n_records=1):
    """Signals of machines with bearings at rest, shape (record, channel, time), and their scenarios."""
    scenarios = draw_scenarios(recipe, 0, n_records)
    return measure(silence(recipe, n_records), scenarios).signal.astype(float), scenarios
