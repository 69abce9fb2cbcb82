"""Ends of lives that are seen in the records: the first snapshot beyond a limit of the test, and the first one that shows its spall."""

import math
from collections import defaultdict
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft, rfftfreq

from gen.measurement.judging import WINDOW_RMS
from gen.measurement.measure import Measured
from gen.recipe import Snapshot
from gen.recipe.life import LifeEnd
from gen.scenarios import Scenario, same_recording
from gen.support.units import to_si

VELOCITY_BAND = 10.0, 1000.0
"""Band of the rms velocity in ISO 20816-1:2016 [Hz]."""


def with_ends(measured: Measured, end: LifeEnd) -> tuple[Measured, list[int]]:
    """Records of whole lives with what is known of each life when it has ended, and the places of records behind its end."""
    fs, of_specimen = same_recording(measured.scenarios).recording.sample_rate_hz, defaultdict[int, list[int]](list)
    for place, scenario in enumerate(measured.scenarios):
        of_specimen[scenario.origin.specimen].append(place)
    scenarios, behind, limited = [*measured.scenarios], list[int](), bool(end.peak_m_s2 or end.velocity_mm_s)
    for places in of_specimen.values():
        last = next((at for at, place in enumerate(places) if limited and _is_beyond(measured, place, end, fs)), None)
        of_end = None if last is None else _life(scenarios[places[last]])
        behind += [] if last is None else places[last + 1 :]
        seen = next((_life(scenarios[place]).age for place in places if measured.detectable[place] == 1), None)
        for place in places:
            life = _life(scenarios[place]).model_copy(update={"first_detectable_time": seen})
            if of_end is not None:
                life = _ended_at(life, of_end)
            elif limited and not life.event:
                life = life.model_copy(update={"rul": None, "rul_revolutions": None})
            origin = scenarios[place].origin.model_copy(update={"life": life})
            scenarios[place] = scenarios[place].edited(origin=origin)
    return replace(measured, scenarios=scenarios), behind


def velocity_rms(acceleration: NDArray[np.floating], fs: float) -> float:
    """Rms velocity in the band of ISO 20816, of the channel where it is largest, from shape (channel, time) [m/s]."""
    n = acceleration.shape[-1]
    steady = acceleration - acceleration.mean(axis=-1, keepdims=True)
    frequency = rfftfreq(n, 1 / fs)
    band = (frequency >= VELOCITY_BAND[0]) & (frequency <= VELOCITY_BAND[1])
    lines = np.abs(rfft(steady * np.hanning(n)))[:, band] / (2 * np.pi * frequency[band])
    return float(np.sqrt(2 * (lines**2).sum(axis=-1).max()) / (WINDOW_RMS * n))


def _is_beyond(measured: Measured, place: int, end: LifeEnd, fs: float) -> bool:
    signal = measured.signal[place] / (measured.counts_per_unit or 1.0)
    peak = float(np.abs(signal - signal.mean(axis=-1, keepdims=True)).max())
    if peak >= (end.peak_m_s2 or math.inf):
        return True
    return end.velocity_mm_s is not None and velocity_rms(signal, fs) >= to_si(end.velocity_mm_s, "mm_s")


def _life(scenario: Scenario) -> Snapshot:
    assert scenario.origin.life is not None  # noqa: S101
    return scenario.origin.life


def _ended_at(life: Snapshot, of_end: Snapshot) -> Snapshot:
    """A snapshot of a bearing that failed at another one."""
    rul, turns = (getattr(life, name) - getattr(of_end, name) for name in ("rul", "rul_revolutions"))
    return life.model_copy(update={"rul": rul, "rul_revolutions": turns, "event": 1})
