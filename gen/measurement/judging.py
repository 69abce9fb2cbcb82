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
from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import ifft, rfft

from gen.scenarios import Gains

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]

FALSE_ALARM = 1e-3
BANDS = 4  # of equal width up to half the sample rate, searched beside the whole
HARMONICS = 3
TOLERANCE = 0.01  # of a fault order, beyond one line of the spectrum: slip and ball motion widen a line
_LEAST_SAMPLES = 16  # of a band


class Parts(NamedTuple):
    """Parts of one record before their gains."""

    fault: Float32Array
    """What the fault adds, shape (channel, time), as the next two [m s-2]."""
    healthy: Float32Array
    """The bearing without it [m s-2]."""
    background: Float32Array
    """[1]."""
    orders: tuple[float, ...]
    """Order of the shaft at which the fault of each damaged part repeats [1]."""
    angles: FloatArray
    """Angle of the shaft, shape (time,) [rad]."""
    steady: bool
    """True if the speed is nearly constant, so that lines in frequency are lines in order."""


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
    cycles: tuple[list[int], ...]
    """For each damaged part the cycles per record, in rising order, at which its line may lie."""
    chance: float
    """Logarithm of the number of searched lines, in all bands of all channels, over the probability of a false alarm."""

    def searched(self, band: tuple[int, int]) -> list[list[int]]:
        """Cycles per record at which the squared envelope of a band is searched for the line of each damaged part."""
        return _within(self.cycles, band)


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


def bands_of(n: int) -> list[tuple[int, int]]:
    """First frequency of each band and the one after its last, for ``n`` samples: all frequencies, then their quarters."""
    half = n // 2
    every = [(1, half), *((max(1, half * k // BANDS), half * (k + 1) // BANDS) for k in range(BANDS))]
    return [(low, high) for low, high in every if high - low >= _LEAST_SAMPLES]


def spectra_of(records: Sequence[Parts]) -> list[Spectra]:
    """Spectra of records of one length; they are transformed side by side, which takes a third of the time."""
    n = records[0].fault.shape[1]
    transformed = rfft(np.stack([part for record in records for part in record[:3]]))
    spectra = []
    for record, of_fault, of_healthy, of_background in zip(
        records, transformed[::3], transformed[1::3], transformed[2::3], strict=True
    ):
        turns = (record.angles[-1] - record.angles[0]) / (2 * math.pi) * n / (n - 1)
        cycles = tuple(_cycles(order * turns) for order in record.orders)
        lines = len(of_fault) * sum(len(some) for band in bands_of(n) for some in _within(cycles, band))
        angles, chance = None if record.steady else record.angles, math.log(max(lines, 1) / FALSE_ALARM)
        spectra.append(Spectra(of_fault, of_fault + of_healthy, of_background, n, angles, cycles, chance))
    return spectra


def _cycles(once: float) -> list[int]:
    """Whole numbers of cycles within the tolerance of the multiples of ``once``."""
    cycles: set[int] = set()
    for multiple in range(1, HARMONICS + 1):
        middle = multiple * once
        reach = 1 + TOLERANCE * middle
        cycles.update(range(max(1, math.ceil(middle - reach)), math.floor(middle + reach) + 1))
    return sorted(cycles)


def _within(cycles: Sequence[list[int]], band: tuple[int, int]) -> list[list[int]]:
    """Those cycles that the squared envelope of a band can have."""
    highest = (band[1] - band[0]) // 2
    return [some[: bisect_right(some, highest)] for some in cycles]


def parts_seen(bands: Bands, gains: Gains) -> NDArray[np.bool_]:
    """Whether the line of each damaged part stands out of the record in some band of some channel, shape (part,)."""
    b, n = gains.bearing, gains.background
    whole = b * b * bands.bearing + 2 * b * n * bands.cross + n * n * bands.background
    return np.any(b * b * bands.lines > bands.thresholds * whole, axis=(1, 2))


class Judge:
    """Tells for any gains whether the fault of a record can be seen; bands beyond the first are searched when one needs them."""

    def __init__(self, spectra: Spectra, first: Bands) -> None:
        self._spectra = spectra
        self._bands = [first]

    def sees(self, gains: Gains) -> bool:
        """Whether every damaged part can be seen in some band."""
        seen = parts_seen(self._bands[0], gains)
        further = bands_of(self._spectra.n)[1:]
        if seen.all() or not further:
            return bool(seen.all())
        if len(self._bands) == 1:
            self._bands += judge_bands([self._spectra], further)
        return bool((seen | parts_seen(self._bands[1], gains)).all())


def judges_of(records: Sequence[Parts]) -> list[Judge]:
    """Judges of records of one length."""
    if not records:
        return []
    spectra = spectra_of(records)
    first = judge_bands(spectra, bands_of(spectra[0].n)[:1])
    return [Judge(*both) for both in zip(spectra, first, strict=True)]


def judge_bands(spectra: Sequence[Spectra], bands: list[tuple[int, int]]) -> list[Bands]:
    """Lines and powers of some records in some of their bands."""
    bands_of_records = [
        Bands(
            lines=np.zeros((len(one.cycles), len(one.fault), len(bands))),
            bearing=np.zeros((len(one.fault), len(bands))),
            background=np.zeros((len(one.fault), len(bands))),
            cross=np.zeros((len(one.fault), len(bands))),
            thresholds=np.array([math.sqrt(one.chance / (high - low)) for low, high in bands]),
        )
        for one in spectra
    ]
    for place, (low, high) in enumerate(bands):
        _set_lines(bands_of_records, spectra, place, (low, high))
        for one, of_one in zip(spectra, bands_of_records, strict=True):
            bearing, background = one.bearing[:, low:high], one.background[:, low:high]
            cross = np.sum((bearing * np.conj(background)).real, axis=1, dtype=np.float64)
            powers = _power(bearing), _power(background), cross
            for row, power in zip((of_one.bearing, of_one.background, of_one.cross), powers, strict=True):
                row[:, place] = (2 / one.n) ** 2 * power
    return bands_of_records


def _power(spectrum: NDArray[np.complexfloating]) -> FloatArray:
    return np.asarray(np.sum(spectrum.real**2 + spectrum.imag**2, axis=1, dtype=np.float64))


def _set_lines(bands_of_records: list[Bands], spectra: Sequence[Spectra], place: int, band: tuple[int, int]) -> None:
    """Set the largest lines of the squared envelopes of a band, the one at ``place``; they stay 0 where the band is too narrow."""
    wide = [(of_one, one) for of_one, one in zip(bands_of_records, spectra, strict=True) if any(one.searched(band))]
    if not wide:
        return
    signal = ifft(np.stack([one.fault[:, slice(*band)] for _, one in wide]) * (2 / wide[0][1].n), norm="forward")
    envelopes = signal.real**2 + signal.imag**2
    every = np.abs(rfft(envelopes)) / envelopes.shape[2]
    for (of_one, one), envelope, lines in zip(wide, envelopes, every, strict=True):
        of_orders = lines if one.angles is None else _over_angle(envelope, one.angles)
        for part, cycles in enumerate(one.searched(band)):
            if cycles:
                of_one.lines[part, :, place] = of_orders[:, cycles].max(axis=1)


def _over_angle(envelope: FloatArray, angles: FloatArray) -> FloatArray:
    """Lines of an envelope over the angle of the shaft, shape (channel, cycle); ``angles`` are those of a whole record."""
    count, n = envelope.shape[1], len(angles)
    at = np.interp(np.arange(count) * (n / count), np.arange(n), angles)
    even = np.linspace(at[0], at[-1], count)
    return np.abs(rfft(np.stack([np.interp(even, at, row) for row in envelope]))) / count
