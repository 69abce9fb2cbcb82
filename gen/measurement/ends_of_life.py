"""Ends of lives that are seen in the records: the first snapshot beyond a limit of the test, and the first one that shows its spall."""

import math
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft, rfftfreq

from gen.measurement.judging import WINDOW_RMS
from gen.measurement.measure import Measured, counts_per_unit
from gen.recipe import Snapshot
from gen.recipe.life import LifeEnd
from gen.simulation.simulate import Run
from gen.support.units import to_si

VELOCITY_BAND = 10.0, 1000.0
"""Band of the rms velocity in ISO 20816-1:2016 [Hz]."""


def with_ends(runs: Sequence[Run], records: Sequence[Measured | str], end: LifeEnd) -> list[Measured | str]:
    """Records of whole lives with what is known of each life when it has ended; those behind its end are empty."""
    lives, limited = defaultdict[int, list[int]](list), bool(end.peak_m_s2 or end.velocity_mm_s)
    for place, run in enumerate(runs):
        lives[run.scenario.origin.specimen].append(place)
    ended = [*records]
    # limits of the test end a life at the first snapshot beyond them
    for places in lives.values():
        whole = [(place, record) for place in places if not isinstance(record := records[place], str)]
        last = next((place for place, record in whole if limited and _is_beyond(record, end)), None)
        tested = [record for place, record in whole if last is None or place <= last]
        seen = next((_life(record).age for record in tested if record.detectable == 1), None)
        for place, record in whole:
            life = _life(record).model_copy(update={"first_detectable_time": seen})
            if last is not None:
                life = _ended_at(life, _life(records[last]))
            # such a test may have ended before any limit was reached: the remaining life is not known
            elif limited and not life.event:
                life = life.model_copy(update={"rul": None, "rul_revolutions": None})
            origin = record.scenario.origin.model_copy(update={"life": life})
            ended[place] = record._replace(scenario=record.scenario.edited(origin=origin))
        if last is not None:
            # the machine stands still after its end
            ended = ["" if place in places and place > last else record for place, record in enumerate(ended)]
    return ended


def velocity_rms(acceleration: NDArray[np.floating], fs: float) -> float:
    """Rms velocity in the band of ISO 20816, of the channel where it is largest, from shape (channel, time) [m/s]."""
    n = acceleration.shape[-1]
    steady = acceleration - acceleration.mean(axis=-1, keepdims=True)
    frequency = rfftfreq(n, 1 / fs)
    band = (frequency >= VELOCITY_BAND[0]) & (frequency <= VELOCITY_BAND[1])
    lines = np.abs(rfft(steady * np.hanning(n)))[:, band] / (2 * np.pi * frequency[band])
    return float(np.sqrt(2 * (lines**2).sum(axis=-1).max()) / (WINDOW_RMS * n))


def _is_beyond(record: Measured, end: LifeEnd) -> bool:
    recipe = record.scenario.recipe
    signal = record.signal / (counts_per_unit(recipe) or 1.0)
    peak = float(np.abs(signal - signal.mean(axis=-1, keepdims=True)).max())
    if peak >= (end.peak_m_s2 or math.inf):
        return True
    return end.velocity_mm_s is not None and velocity_rms(signal, recipe.recording.sample_rate_hz) >= to_si(
        end.velocity_mm_s, "mm_s"
    )


def _life(record: Any) -> Snapshot:
    return record.scenario.origin.life


def _ended_at(life: Snapshot, of_end: Snapshot) -> Snapshot:
    """A snapshot of a bearing that failed at another one."""
    rul, turns = (getattr(life, name) - getattr(of_end, name) for name in ("rul", "rul_revolutions"))
    return life.model_copy(update={"rul": rul, "rul_revolutions": turns, "event": 1})
