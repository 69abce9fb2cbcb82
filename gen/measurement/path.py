"""Vibration of the bearing of a record, and its way to the sensors."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.measurement.rig import RigFilters
from gen.scenarios import Scenario
from gen.simulation.simulate import Twin

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]


class Vibration(NamedTuple):
    """Vibration of the bearing of one record."""

    scenario: Scenario
    filters: RigFilters
    angles: FloatArray
    """Angle of the shaft, shape (time,) [rad]."""
    orders: tuple[float, ...]
    """Order of the shaft at which the fault of each damaged part repeats [1]."""
    bearing: Float32Array
    """Without the fault, then what the fault adds if that is known, shape (part, channel, time) [m s-2]."""


def with_twin(acceleration: Float32Array, twin: Twin | None) -> tuple[tuple[float, ...], Float32Array]:
    """Orders and signals of a :class:`Vibration`, of an acceleration of shape (channel, time) [m s-2]."""
    if twin is None:
        return (), acceleration[None]
    return twin.orders, np.stack([twin.acceleration, acceleration - twin.acceleration])


def through_paths(vibrations: Sequence[Vibration]) -> list[Vibration]:
    """Vibrations behind the transfer paths; filters may make them longer.

    The convolution is circular: its wrap-around falls into the lead ahead of the record, which is dropped.
    """
    resonant = [one for one in vibrations if one.filters.direct is None]
    behind = iter(())
    if resonant:
        n, ends = resonant[0].filters.n, np.cumsum([len(one.bearing) for one in resonant])[:-1]
        spectra = rfft(np.concatenate([one.bearing for one in resonant]), n)
        for spectrum, one in zip(np.split(spectra, ends), resonant, strict=True):
            spectrum *= one.filters.bearing_paths
        behind = iter(np.split(irfft(spectra, n), ends))
    return [
        one._replace(bearing=next(behind) if one.filters.direct is None else one.bearing * one.filters.direct)
        for one in vibrations
    ]
