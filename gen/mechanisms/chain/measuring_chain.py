"""Faults of the measuring chain, from the mount of a sensor to the transfer of its samples.

::

    machine -> mount -> cable -> gain -> amplifier -> converter -> transfer
               rattle   drift    steps   limit                     gaps
                        hum
                        bursts

Drift, hum and bursts enter ahead of the amplifier: they use up its range, and it amplifies them. A gain that steps up drives the amplifier
into its limit. Gaps come last; a converter acts on each sample by itself, so they may be made before it with the same result.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from gen.drawing import Section
from gen.mechanisms.chain.drift import Drift
from gen.mechanisms.chain.dropped_samples import DroppedSamples
from gen.mechanisms.chain.emi_bursts import EmiBursts
from gen.mechanisms.chain.gain_steps import GainSteps
from gen.mechanisms.chain.loose_mount import LooseMount
from gen.mechanisms.chain.mains_hum import MainsHum
from gen.mechanisms.chain.saturation import Saturation
from gen.mechanisms.chain.sensor_fault import SensorFault
from gen.mechanisms.mechanism import FloatArray, mechanisms_of, section_with, unusable_result, with_plugins

CHAIN: tuple[type[SensorFault], ...] = with_plugins(
    SensorFault, (LooseMount, Drift, MainsHum, EmiBursts, GainSteps, Saturation, DroppedSamples)
)
"""All faults, in the order in which a signal meets them; those of plug-ins come last."""


class _SensorFaults(Section):
    """Faults of the measuring chain, each with variables in the corpus; a fault that is left out does not occur."""


if TYPE_CHECKING:
    SensorFaultsSection = Section
else:
    SensorFaultsSection = section_with("SensorFaultsSection", __name__, _SensorFaults, CHAIN)


def disturb(
    signal: FloatArray, section: Section, fs: float, stream: Callable[[str], np.random.Generator]
) -> tuple[FloatArray, dict[str, float]]:
    """Signal with all faults of a drawn section, and the values of the labels of those that are in it.

    Parameters
    ----------
    signal : array, shape (channel, time)
        Record at its final level, ahead of the converter [m s-2].
    section : Section
        The faults that the record has.
    fs : float
        Sample rate [Hz].
    stream : callable
        Gives a random stream of the record by its name.

    Returns
    -------
    array, shape (channel, time), of the type of ``signal``
        The ``signal`` itself if there is no fault.

    Raises
    ------
    RacewayError
        If a fault of a plug-in does not return a signal of this shape and the values of its labels.
    """
    dtype, labels = signal.dtype, dict[str, float]()
    for fault in mechanisms_of(section):
        result: Any = fault.disturb(signal, fs, stream(f"sensor_faults.{fault.place}"))
        count = len(fault.labels)
        if not isinstance(result, tuple) or len(result) != 1 + count or np.shape(result[0]) != signal.shape:
            wanted = f"a tuple of the signal, shape {signal.shape}, and the values of its {count} labels"
            raise unusable_result(fault, "disturb", wanted)
        signal, *values = result
        labels |= zip([label.name for label in fault.labels], values, strict=True)
    return signal.astype(dtype, copy=False), labels
