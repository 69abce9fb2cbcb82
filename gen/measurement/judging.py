"""Can the fault of a record be seen in it? Its line in the squared envelope spectrum is compared with that of its twin.

The twin is the same record without its fault. In every band, the largest line of the record near a harmonic of the fault order is compared
with the largest line of the twin in the same place. A line of noise is a complex Gaussian number [1]_; let ``s^2`` be its mean square. A
line of two recordings of one machine, which differ in their noise alone, differs by more than ``m`` with a probability of at most
``exp(-m^2 / (2 s^2))``, whatever the machine itself adds to it. A fault is detectable if, in some band and at some harmonic, its line

- exceeds that of the twin by more than noise would, with the probability ``FALSE_ALARM`` in the whole search, and
- is ``CLEAR`` times as large as the floor of the record's own spectrum: an impulse raises all lines, and none of them stands out.

``s`` and the floor come from the medians over the lines around the harmonic, which include colour, modulation and impulses of the machine.
Where several parts are damaged, each of them must show its line.

.. [1] P. Borghesani, P. Pennacchi, R. Ricci, S. Chatterton, Testing second order cyclostationarity in the squared envelope spectrum of
   non-white vibration signals, Mechanical Systems and Signal Processing 40 (2013) 38-55.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import ifft, next_fast_len, rfft

from gen.scenarios import Gains

FloatArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]
Float32Array = NDArray[np.float32]

FALSE_ALARM = 1e-3
CLEAR = 2.0  # amplitude of a line over the floor around it: 6 dB
BANDS = 4  # of equal width up to half the sample rate, searched beside the whole
HARMONICS = 3
TOLERANCE = 0.01  # of a fault order, beyond one line of the spectrum: slip and ball motion widen a line
AROUND = 32  # lines on either side of a searched window that tell its floor
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


class Window(NamedTuple):
    """Lines of a spectrum, in cycles per record, that are searched for one harmonic of a damaged part."""

    part: int
    first: int
    stop: int

    @property
    def around(self) -> slice:
        """Lines that tell the floor."""
        return slice(max(1, self.first - AROUND), self.stop + AROUND)


Lines = list[tuple[Window, ComplexArray]]
"""Windows of a band with the lines around each, shape (product, channel, line), of the products of :func:`_lines_of`."""


class Judge:
    """Tells for any gains whether the fault of a record can be seen; a band is transformed once, when it is needed."""

    def __init__(self, record: Parts, spectra: ComplexArray) -> None:
        n = record.fault.shape[1]
        turns = (record.angles[-1] - record.angles[0]) / (2 * math.pi) * n / (n - 1)
        self._spectra, self._angles = spectra, None if record.steady else record.angles
        windows = [
            _window(part, harmonic * order * turns)
            for part, order in enumerate(record.orders)
            for harmonic in range(1, HARMONICS + 1)
        ]
        self._bands = [(band, [one for one in windows if one.stop <= _lines_in(band)]) for band in bands_of(n)]
        searched = len(record.fault) * sum(one.stop - one.first for _, some in self._bands for one in some)
        self._margin = math.sqrt(2 * math.log(max(searched, 1) / FALSE_ALARM))
        self._lines: list[Lines] = []
        self._n_parts = len(record.orders)

    def sees(self, gains: Gains) -> bool:
        """Whether every damaged part can be seen in some band of some channel."""
        seen: set[int] = set()
        for place, (band, windows) in enumerate(self._bands):
            if place == len(self._lines):
                self._lines.append(_lines_of(self._spectra, band, windows, self._angles))
            seen |= {
                window.part for window, lines in self._lines[place] if _stands_out(window, lines, gains, self._margin)
            }
            if len(seen) == self._n_parts:
                return True
        return False


def judges_of(records: Sequence[Parts]) -> list[Judge]:
    """Judges of records of one length; they are transformed side by side, which takes a third of the time."""
    if not records:
        return []
    transformed = rfft(np.stack([part for record in records for part in record[:3]]))
    return [Judge(record, transformed[3 * place : 3 * place + 3]) for place, record in enumerate(records)]


def bands_of(n: int) -> list[tuple[int, int]]:
    """First frequency of each band and the one after its last, for ``n`` samples: all frequencies, then their quarters."""
    half = n // 2
    every = [(1, half), *((max(1, half * k // BANDS), half * (k + 1) // BANDS) for k in range(BANDS))]
    return [(low, high) for low, high in every if high - low >= _LEAST_SAMPLES]


def _window(part: int, middle: float) -> Window:
    """Lines within the tolerance of ``middle`` cycles per record."""
    reach = 1 + TOLERANCE * middle
    return Window(part, max(1, math.ceil(middle - reach)), math.floor(middle + reach) + 1)


def _lines_in(band: tuple[int, int]) -> int:
    """Number of lines that the squared envelope of a band has, that at 0 included."""
    return (band[1] - band[0]) // 2 + 1


def _lines_of(
    spectra: ComplexArray, band: tuple[int, int], windows: Sequence[Window], angles: FloatArray | None
) -> Lines:
    """Lines of the products that make up the squared envelope of a band, around each window, before the gains.

    With bearing ``b`` and background ``n``, ``|b + n|^2 = |b|^2 + 2 Re(b n*) + |n|^2``. The products are ``|b|^2`` with and without
    the fault, ``2 Re(b n*)`` with and without it, and ``|n|^2``.
    """
    if not windows:
        return []
    signals = ifft(spectra[..., slice(*band)], next_fast_len(band[1] - band[0]), norm="forward")
    fault, healthy, background = signals
    bearing = np.stack([fault + healthy, healthy])
    products = np.concatenate([_squared(bearing), 2 * (bearing * np.conj(background)).real, _squared(background)[None]])
    if angles is not None:
        products = _over_angle(products, angles)
    lines = rfft(products)
    return [(window, lines[..., window.around]) for window in windows]


def _squared(signal: ComplexArray) -> FloatArray:
    return signal.real**2 + signal.imag**2


def _stands_out(window: Window, lines: ComplexArray, gains: Gains, margin: float) -> bool:
    """Whether the line of the record in a window exceeds that of the twin by ``margin`` times the floor, and is clear, in some channel."""
    b, n = gains.bearing, gains.background
    sizes = np.abs(b * b * lines[:2] + b * n * lines[2:4] + n * n * lines[4])
    # the square of a line of noise has an exponential distribution, whose median is ln 2 of its mean
    middle = sizes.shape[-1] // 2
    floor, floor_of_twin = np.partition(sizes, middle)[..., middle] / math.sqrt(math.log(2))
    first = window.first - window.around.start
    line, line_of_twin = sizes[..., first : first + window.stop - window.first].max(axis=-1)
    return bool(np.any((line - line_of_twin > margin * floor_of_twin) & (line > CLEAR * floor)))


def _over_angle(signals: FloatArray, angles: FloatArray) -> FloatArray:
    """Signals of a band over the angle of the shaft, at even steps, shape (..., sample); ``angles`` are those of a whole record."""
    count, n = signals.shape[-1], len(angles)
    at = np.interp(np.arange(count) * (n / count), np.arange(n), angles)
    even = np.linspace(at[0], at[-1], count)
    return np.apply_along_axis(lambda row: np.interp(even, at, row), -1, signals)
