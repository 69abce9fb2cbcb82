"""Can the fault of a record be seen in it? A test of the line of its class in the squared envelope spectrum.

The fault's own part of a record is its difference to the same record without the fault. In every band, the largest line of that part at
the fault order of the class, or at twice or three times that order, is compared with the power of the whole record in the band. In the
squared envelope of Gaussian noise of that power and of ``N`` independent complex samples, a line of ``I`` times the mean has a probability
of ``exp(-N I^2)`` [1]_. A fault is detectable if in some band its line would be a false alarm of noise with a probability of less than
``FALSE_ALARM`` in the whole search.

.. [1] P. Borghesani, P. Pennacchi, R. Ricci, S. Chatterton, Testing second order cyclostationarity in the squared envelope spectrum of
   non-white vibration signals, Mechanical Systems and Signal Processing 40 (2013) 38-55.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import ifft, rfft

from gen.measurement.levels import Gains

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]

FALSE_ALARM = 1e-3
BANDS = 4  # of equal width up to half the sample rate, searched beside the whole
HARMONICS = 3
TOLERANCE = 0.01  # of a fault order, beyond one line of the spectrum: slip and ball motion widen a line
_LEAST_SAMPLES = 16  # of a band


class Bands(NamedTuple):
    """Parts of a record in each band of each channel, before the gains; every array but the last has shape (channel, band)."""

    lines: FloatArray
    """Largest line of the fault's squared envelope at the orders of its class."""
    bearing: FloatArray
    """Power of the bearing with its fault."""
    background: FloatArray
    cross: FloatArray
    """Mean product of both."""
    thresholds: FloatArray
    """Line over power at which noise gives a false alarm, shape (band,)."""


def judged_bands(
    fault: Float32Array,
    healthy: Float32Array,
    background: Float32Array,
    orders: tuple[float, ...],
    angles: FloatArray,
    *,
    steady: bool,
) -> Bands:
    """Lines and powers in each band of one record.

    Parameters
    ----------
    fault, healthy, background : array, shape (channel, time)
        What the fault adds, the bearing without it [m s-2], and the background [1].
    orders : tuple of float
        Orders of the shaft at which the faults of the record repeat [1].
    angles : array, shape (time,)
        Angle of the shaft [rad].
    steady : bool
        True if the speed is nearly constant, so that lines in frequency are lines in order.
    """
    n = fault.shape[1]
    of_fault, of_healthy, of_background = rfft(np.stack([fault, healthy, background]))
    of_bearing = of_fault + of_healthy
    edges = [(1, n // 2), *((max(1, n // 2 * k // BANDS), n // 2 * (k + 1) // BANDS) for k in range(BANDS))]
    edges = [(low, high) for low, high in edges if high - low >= _LEAST_SAMPLES]
    columns = [
        (_power(of_bearing[:, low:high]), _power(of_background[:, low:high]),
         np.sum((of_bearing[:, low:high] * np.conj(of_background[:, low:high])).real, axis=1, dtype=np.float64))
        for low, high in edges
    ]  # fmt: skip
    bearing, noise, cross = (np.stack(column, axis=1) * (4 / n**2) for column in zip(*columns, strict=True))
    found = [_largest_line(of_fault[:, low:high] * (2 / n), orders, angles, steady=steady) for low, high in edges]
    looks = max(sum(count for _, count in found), 1)
    thresholds = [math.sqrt(math.log(looks / FALSE_ALARM) / (high - low)) for low, high in edges]
    return Bands(np.stack([line for line, _ in found], axis=1), bearing, noise, cross, np.array(thresholds))


def _power(spectrum: NDArray[np.complexfloating]) -> FloatArray:
    return np.sum(spectrum.real**2 + spectrum.imag**2, axis=1, dtype=np.float64)


def is_detectable(bands: Bands, gains: Gains) -> bool:
    """Whether the line of the fault stands out of the record in some band of some channel."""
    b, n = gains
    whole = b * b * bands.bearing + 2 * b * n * bands.cross + n * n * bands.background
    return bool(np.any(b * b * bands.lines > bands.thresholds * whole))


def _largest_line(
    spectrum: NDArray[np.complexfloating], orders: tuple[float, ...], angles: FloatArray, *, steady: bool
) -> tuple[FloatArray, int]:
    """Largest line of the squared envelope of a band at the orders and their multiples, shape (channel,), and the number searched."""
    signal = ifft(spectrum, norm="forward")
    envelope = signal.real**2 + signal.imag**2
    count = envelope.shape[1]
    if not steady:
        at = np.interp(np.arange(count) * (len(angles) / count), np.arange(len(angles)), angles)
        even = np.linspace(at[0], at[-1], count)
        envelope = np.stack([np.interp(even, at, row) for row in envelope])
    lines = np.abs(rfft(envelope)) / count
    turns = (angles[-1] - angles[0]) / (2 * math.pi) * (len(angles) / (len(angles) - 1))
    places: set[int] = set()
    for order in orders:
        for multiple in range(1, HARMONICS + 1):
            middle = multiple * order * turns
            reach = 1 + TOLERANCE * middle
            places.update(range(max(1, math.ceil(middle - reach)), math.floor(middle + reach) + 1))
    searched = [place for place in sorted(places) if place < lines.shape[1]]
    if not searched:
        return np.zeros(len(lines)), 0
    return lines[:, searched].max(axis=1).astype(np.float64), len(searched)
