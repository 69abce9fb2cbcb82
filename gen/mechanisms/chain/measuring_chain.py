"""Faults of the measuring chain, from the mount of a sensor to the transfer of its samples.

::

    machine -> mount -> cable -> gain -> amplifier -> converter -> transfer
               rattle   drift    steps   limit                     gaps
                        hum
                        bursts

Drift, hum and bursts enter ahead of the amplifier: they use up its range, and it amplifies them. A gain that steps up drives the amplifier
into its limit. Gaps come last; a converter acts on each sample by itself, so they may be made before it with the same result.
Each fault has random streams of its own, so one that is added to a recipe or removed from it moves no value of another.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from gen.drawing import Drawn, Draws, Section
from gen.mechanisms.chain.drift import Drift
from gen.mechanisms.chain.dropped_samples import DroppedSamples
from gen.mechanisms.chain.emi_bursts import EmiBursts
from gen.mechanisms.chain.gain_steps import GainSteps
from gen.mechanisms.chain.loose_mount import LooseMount
from gen.mechanisms.chain.mains_hum import MainsHum
from gen.mechanisms.chain.saturation import Saturation
from gen.mechanisms.chain.sensor_fault import SensorFault
from gen.mechanisms.mechanism import FloatArray, is_flat, mechanisms_of, section_with

CHAIN: tuple[type[SensorFault], ...] = (LooseMount, Drift, MainsHum, EmiBursts, GainSteps, Saturation, DroppedSamples)
"""All faults, in the order in which a signal meets them."""


class _SensorFaults(Section):
    """Faults of the measuring chain, each with variables in the corpus; a fault that is left out does not occur."""


if TYPE_CHECKING:
    SensorFaultsSection = Section
else:
    SensorFaultsSection = section_with("SensorFaultsSection", __name__, _SensorFaults, CHAIN)


def draw_for_rig(section: Section, rng: np.random.Generator, rig: int, channels: int) -> Drawn:
    """Faults that a rig has as long as it stands."""
    streams = rng.spawn(len(CHAIN))
    found = {
        fault.place: fault.draw(Draws(streams[fault.rig_stream], rig, f"rig {rig}"), channels)
        for fault in mechanisms_of(section)
        if fault.rig_stream is not None
    }
    return {place: drawn for place, drawn in found.items() if drawn is not None}


def draw_for_record(section: Section, rng: np.random.Generator, record: int) -> Drawn:
    """Faults that come and go, and what faults of rigs have anew in each record."""
    present = [fault for fault in mechanisms_of(section) if fault.record_stream is not None]
    streams, found = rng.spawn(len(CHAIN)) if present else [], dict[str, Any]()
    for fault in present:
        draws = Draws(streams[fault.record_stream], record, f"record {record}")
        found[fault.place] = fault.draw(draws, 0) if fault.rig_stream is None else fault.draw_anew(draws)
    return {place: drawn for place, drawn in found.items() if drawn is not None}


def foreign(of_rig: Drawn, of_record: Drawn, channels: int) -> str | None:
    """Name of a drawn fault, which may come from a file, that is none of the chain, of its level or of its form; None without one."""
    by_place = {fault.place: fault for fault in CHAIN}
    for drawn, of_rigs in ((of_rig, True), (of_record, False)):
        for place, values in drawn.items():
            fault = by_place.get(place)
            if fault is None:
                return place
            anew = not of_rigs and fault.rig_stream is not None and fault.record_stream is not None
            its_level = of_rigs == (fault.rig_stream is not None)
            if not (is_flat(values) if anew else its_level and fault.has_form(values, channels)):
                return place
    return None


def disturb(
    signal: FloatArray, of_rig: Drawn, of_record: Drawn, fs: float, rng: np.random.Generator
) -> tuple[FloatArray, dict[str, float]]:
    """Signal with all faults of a rig and a record, and the values of the labels of those that are in it.

    Parameters
    ----------
    signal : array, shape (channel, time)
        Record at its final level, ahead of the converter [m s-2].
    of_rig, of_record : dict
        Drawn values of the faults.
    fs : float
        Sample rate [Hz].
    rng : Generator
        Source of random times and phases.

    Returns
    -------
    array, shape (channel, time), of the type of ``signal``
        The ``signal`` itself if there is no fault, or if the record diverged: then it is left out of the corpus.
    """
    if not np.isfinite(signal).all():
        return signal, {}
    given, streams, labels = signal, rng.spawn(len(CHAIN)), dict[str, float]()
    for fault in CHAIN:
        drawn = (of_record if fault.rig_stream is None else of_rig).get(fault.place)
        if drawn is not None:
            anew = of_record.get(fault.place)
            if fault.rig_stream is not None and isinstance(drawn, dict) and isinstance(anew, dict):
                drawn = drawn | anew
            signal, found = fault.disturb(drawn, signal, fs, streams[fault.noise_stream])
            labels |= found
    return signal.astype(given.dtype, copy=False), labels
