"""Visibility of the fault of the bearing at the other end of the shaft.

The two bearings change their roles: the record is measured again at its gains, with the fault of the other bearing in place of its own,
and all else in place of the bearing without a fault.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gen.measurement.measure import Measured, measure
from gen.scenarios import Scenario
from gen.simulation.simulate import Twins


def with_other_faults(measured: Measured, acceleration: NDArray[np.float32], twins: Twins | None) -> Measured:
    """Measured records with the levels of the faults of their other bearings; ``acceleration`` and ``twins`` as for :func:`measure`."""
    if twins is None or not twins.others:
        return measured
    places, others = list(twins.others), list(twins.others.values())
    scenarios = [_exchanged(measured, place) for place in places]
    healthy = np.stack([other.acceleration for other in others])
    again = measure(acceleration[places], scenarios, Twins(healthy, [other.orders for other in others]))
    snr, detectable = measured.other_fault_snr.copy(), measured.other_detectable.copy()
    snr[places], detectable[places] = again.fault_snr, again.detectable
    return replace(measured, other_fault_snr=snr, other_detectable=detectable)


def _exchanged(measured: Measured, place: int) -> Scenario:
    """Scenario of a record at its gains with the fault of its other bearing."""
    scenario = measured.scenarios[place]
    assert scenario.other is not None  # noqa: S101
    record = replace(scenario.record, gains=measured.gains[place], pair=-1)
    return replace(scenario, specimen=scenario.other.specimen, record=record)
