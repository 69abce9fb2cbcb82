"""Can the fault of a record be seen in it? A test of the line of its class in the squared envelope spectrum.

The fault's own part of a record is its difference to the same record without the fault. In every band, the largest line of that part at
the fault order of the class, or at twice or three times that order, is compared with the power of the whole record in the band. In the
squared envelope of Gaussian noise of that power and of ``N`` independent complex samples, a line of ``I`` times the mean has a probability
of ``exp(-N I^2)`` [1]_. A fault is detectable if in some band its line would be a false alarm of noise with a probability of less than
``FALSE_ALARM`` in the whole search. Where several parts are damaged, each of them must show its line.

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


class Spectra(NamedTuple):
    """Spectra of the parts of a record, and the lines that are searched; every spectrum has the shape (channel, frequency)."""

    fault: NDArray[np.complexfloating]
    bearing: NDArray[np.complexfloating]
    """With the fault."""
    background: NDArray[np.complexfloating]
    n: int
    """Samples of the record."""
    angles: FloatArray | None
    """Angle of the shaft at each sample, None if the speed is nearly constant [rad]."""
    cycles: tuple[tuple[tuple[int, int], ...], ...]
    """For each damaged part the ranges of cycles per record, first and last, in which its line may lie."""

    @property
    def bands(self) -> list[tuple[int, int]]:
        """First frequency of each band and the one after its last: all frequencies, then their quarters."""
        half = self.n // 2
        every = [(1, half), *((max(1, half * k // BANDS), half * (k + 1) // BANDS) for k in range(BANDS))]
        return [(low, high) for low, high in every if high - low >= _LEAST_SAMPLES]

    def searched(self, band: tuple[int, int]) -> list[list[int]]:
        """Cycles per record at which the squared envelope of a band is searched for the line of each damaged part."""
        highest = (band[1] - band[0]) // 2
        return [
            sorted({cycle for first, last in ranges for cycle in range(first, min(last, highest) + 1)})
            for ranges in self.cycles
        ]

    @property
    def chance(self) -> float:
        """Logarithm of the number of searched lines, in all bands of all channels, over the probability of a false alarm."""
        lines = len(self.fault) * sum(len(cycles) for band in self.bands for cycles in self.searched(band))
        return math.log(max(lines, 1) / FALSE_ALARM)


class Bands(NamedTuple):
    """Powers of a record in some bands of each channel, before the gains, shape (channel, band), and the lines of its fault."""

    lines: FloatArray
    """Largest line of the fault's squared envelope at the orders of each damaged part, shape (part, channel, band)."""
    bearing: FloatArray
    """Power of the bearing with its fault."""
    background: FloatArray
    cross: FloatArray
    """Mean product of both."""
    thresholds: FloatArray
    """Line over power at which noise gives a false alarm, shape (band,)."""


def spectra_of(
    fault: Float32Array,
    healthy: Float32Array,
    background: Float32Array,
    orders: tuple[float, ...],
    angles: FloatArray,
    *,
    steady: bool,
) -> Spectra:
    """Spectra of one record.

    Parameters
    ----------
    fault, healthy, background : array, shape (channel, time)
        What the fault adds, the bearing without it [m s-2], and the background [1].
    orders : tuple of float
        Order of the shaft at which the fault of each damaged part repeats [1].
    angles : array, shape (time,)
        Angle of the shaft [rad].
    steady : bool
        True if the speed is nearly constant, so that lines in frequency are lines in order.
    """
    n = fault.shape[1]
    of_fault, of_healthy, of_background = rfft(np.stack([fault, healthy, background]))
    turns = (angles[-1] - angles[0]) / (2 * math.pi) * n / (n - 1)
    cycles = tuple(tuple(_around(multiple * order * turns) for multiple in range(1, HARMONICS + 1)) for order in orders)
    return Spectra(of_fault, of_fault + of_healthy, of_background, n, None if steady else angles, cycles)


def _around(middle: float) -> tuple[int, int]:
    """First and last whole number of cycles within the tolerance of ``middle``."""
    reach = 1 + TOLERANCE * middle
    return max(1, math.ceil(middle - reach)), math.floor(middle + reach)


def parts_seen(bands: Bands, gains: Gains) -> NDArray[np.bool_]:
    """Whether the line of each damaged part stands out of the record in some band of some channel, shape (part,)."""
    b, n = gains
    whole = b * b * bands.bearing + 2 * b * n * bands.cross + n * n * bands.background
    return np.any(b * b * bands.lines > bands.thresholds * whole, axis=(1, 2))


class Judge:
    """Tells for any gains whether the fault of a record can be seen; bands beyond the first are searched when one needs them."""

    def __init__(self, spectra: Spectra) -> None:
        self._spectra = spectra
        self._found: list[Bands] = []

    def sees(self, gains: Gains) -> bool:
        """Whether every damaged part can be seen in some band."""
        every, seen = self._spectra.bands, np.zeros(len(self._spectra.cycles), bool)
        for place, bands in enumerate((every[:1], every[1:])):
            if place == len(self._found) and bands:
                self._found.append(judged_bands(self._spectra, bands))
            if place < len(self._found):
                seen |= parts_seen(self._found[place], gains)
            if seen.all():
                return True
        return False


def judged_bands(spectra: Spectra, bands: list[tuple[int, int]]) -> Bands:
    """Lines and powers of one record in some of its bands."""
    scale, rows = 2 / spectra.n, []
    for low, high in bands:
        bearing, background = spectra.bearing[:, low:high], spectra.background[:, low:high]
        cross = np.sum((bearing * np.conj(background)).real, axis=1, dtype=np.float64)
        line = _largest_line(spectra.fault[:, low:high] * scale, spectra, (low, high))
        rows.append([line, *(scale**2 * power for power in (_power(bearing), _power(background), cross))])
    lines, of_bearing, of_background, crosses = (np.stack(column, axis=-1) for column in zip(*rows, strict=True))
    thresholds = np.array([math.sqrt(spectra.chance / (high - low)) for low, high in bands])
    return Bands(lines, of_bearing, of_background, crosses, thresholds)


def _power(spectrum: NDArray[np.complexfloating]) -> FloatArray:
    return np.asarray(np.sum(spectrum.real**2 + spectrum.imag**2, axis=1, dtype=np.float64))


def _largest_line(spectrum: NDArray[np.complexfloating], of: Spectra, band: tuple[int, int]) -> FloatArray:
    """Largest line of the squared envelope of a band for each damaged part, shape (part, channel); 0 where the band is too narrow."""
    searched = of.searched(band)
    largest = np.zeros((len(searched), len(spectrum)))
    if not any(searched):
        return largest
    signal = ifft(spectrum, norm="forward")
    envelope = signal.real**2 + signal.imag**2
    count = envelope.shape[1]
    if of.angles is not None:
        at = np.interp(np.arange(count) * (of.n / count), np.arange(of.n), of.angles)
        even = np.linspace(at[0], at[-1], count)
        envelope = np.stack([np.interp(even, at, row) for row in envelope])
    lines = np.abs(rfft(envelope)) / count
    for part, cycles in enumerate(searched):
        if cycles:
            largest[part] = lines[:, cycles].max(axis=1)
    return largest
