"""Can the fault of a record be seen in it? Its line in the squared envelope spectrum is compared with that of its twin.

The twin is the same record without its fault. In every band, the largest line of the record near a harmonic of the fault order is compared
with the largest line of the twin in the same place. A line of noise is a complex Gaussian number [1]_; let ``s^2`` be its mean square. A
line of two recordings of one machine, which differ in their noise alone, differs by more than ``m`` with a probability of at most
``exp(-m^2 / (2 s^2))``, whatever the machine itself adds to it. A fault is detectable if in some band and at some harmonic its line exceeds
that of the twin by more than that, with the probability ``FALSE_ALARM`` in the whole search. Where several parts are damaged, each of them
must show its line.

``s`` comes from the median over the lines of the twin around the harmonic, which includes colour and modulation of the noise. Impulses at
random times may be many in one recording and none in another, so their mean square is added.

.. [1] P. Borghesani, P. Pennacchi, R. Ricci, S. Chatterton, Testing second order cyclostationarity in the squared envelope spectrum of
   non-white vibration signals, Mechanical Systems and Signal Processing 40 (2013) 38-55.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import ifft, next_fast_len, rfft

from gen.physics.kernel.compiling import compiled_to_disk
from gen.scenarios import Gains

FloatArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]
Float32Array = NDArray[np.float32]

FALSE_ALARM = 1e-3
BANDS = 4  # of equal width up to half the sample rate, searched beside the whole
HARMONICS = 3
TOLERANCE = 0.01  # of a fault order, beyond one line of the spectrum: slip and ball motion widen a line
LOWEST = 2  # lines of a Hann window beside that of the mean
WINDOW_RMS = math.sqrt(3 / 8)  # of a Hann window
AROUND = 32  # lines on either side of a searched window that tell its floor
_LEAST_SAMPLES = 16  # of a band


class Parts(NamedTuple):
    """Parts of one record before their gains."""

    fault: Float32Array
    """What the fault adds, shape (channel, time), as the next two; (0, 0) if there is no fault or it is not known [m s-2]."""
    healthy: Float32Array
    """The bearing without it, or the whole bearing [m s-2]."""
    background: Float32Array
    """[1]."""
    impulses: Float32Array
    """Rms of the lines that its impulses at random times make in squared envelopes, by the frequency of the impulses from 0 to half the
    sample rate, shape (channel, frequency) [1].
    """
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
        return slice(max(LOWEST, self.first - AROUND), self.stop + AROUND)


class Judge:
    """Tells for any gains whether the fault of a record can be seen; a band is transformed once, when it is needed."""

    def __init__(self, record: Parts, spectra: ComplexArray) -> None:
        n = record.fault.shape[1]
        turns = (record.angles[-1] - record.angles[0]) / (2 * math.pi) * n / (n - 1)
        self._record, self._spectra = record, spectra
        windows = [
            _window(part, harmonic * order * turns)
            for part, order in enumerate(record.orders)
            for harmonic in range(1, HARMONICS + 1)
        ]
        self._searched = [
            (band, [one for one in windows if one.first < one.stop <= _lines_in(band)]) for band in bands_of(n)
        ]
        searched = len(record.fault) * sum(one.stop - one.first for _, some in self._searched for one in some)
        self._margin = math.sqrt(2 * math.log(max(searched, 1) / FALSE_ALARM))
        self._bands: list[tuple[list[tuple[Window, ComplexArray]], FloatArray]] = []

    def sees(self, gains: Gains) -> bool:
        """Whether every damaged part can be seen in some band of some channel."""
        seen: set[int] = set()
        for place, (frequencies, windows) in enumerate(self._searched):
            if place == len(self._bands):
                self._bands.append(self._band(frequencies, windows))
            of_windows, impulses = self._bands[place]
            for window, lines in of_windows:
                first = window.first - window.around.start
                searched = first, first + window.stop - window.first
                if window.part not in seen and _stands_out(
                    lines, *searched, gains.bearing, gains.background, self._margin, impulses
                ):
                    seen.add(window.part)
            if len(seen) == len(self._record.orders):
                return True
        return False

    def _band(
        self, band: tuple[int, int], windows: Sequence[Window]
    ) -> tuple[list[tuple[Window, ComplexArray]], FloatArray]:
        """Lines of the squared envelope of a band around each window, before the gains, and rms of the lines of its impulses.

        Shapes (product, channel, line), of the products of :func:`_products`, and (channel,).
        """
        if not windows:
            return [], np.empty(0)
        n, impulses = self._record.fault.shape[1], self._record.impulses
        products = _products(self._spectra[..., slice(*band)])
        if not self._record.steady:
            products = _over_angle(products, self._record.angles)
        # the window takes out the step from the end of a record to its start, which the transforms join
        lines = rfft(products * np.hanning(products.shape[-1]).astype(products.dtype))
        share = n / 2 / (impulses.shape[1] - 1)  # of the frequencies of the record in those of the impulses
        places = slice(round(band[0] / share), round(band[1] / share))
        of_impulses = WINDOW_RMS * products.shape[-1] * share**1.5 * impulses[:, places].sum(axis=1)
        # of one type, for which the comparison is compiled once
        kept: list[tuple[Window, ComplexArray]] = [
            (window, lines[..., window.around].astype(np.complex128)) for window in windows
        ]
        return kept, of_impulses.astype(np.float64)


def compile_judging() -> None:
    """Compile the comparison of lines, or fetch it from numba's cache on disk."""
    _stands_out(np.zeros((5, 1, 1), np.complex128), 0, 1, 1.0, 1.0, 1.0, np.zeros(1))


def judges_of(records: Sequence[Parts]) -> list[Judge]:
    """Judges of records of one length; they are transformed side by side, which takes a third of the time."""
    if not records:
        return []
    transformed = rfft(
        np.stack([part for record in records for part in (record.fault, record.healthy, record.background)])
    )
    return [Judge(record, transformed[3 * place : 3 * place + 3]) for place, record in enumerate(records)]


def bands_of(n: int) -> list[tuple[int, int]]:
    """First frequency of each band and the one after its last, for ``n`` samples: all frequencies, then their quarters."""
    half = n // 2
    every = [(1, half), *((max(1, half * k // BANDS), half * (k + 1) // BANDS) for k in range(BANDS))]
    return [(low, high) for low, high in every if high - low >= _LEAST_SAMPLES]


def _window(part: int, middle: float) -> Window:
    """Lines within the tolerance of ``middle`` cycles per record."""
    reach = 1 + TOLERANCE * middle
    return Window(part, max(LOWEST, math.ceil(middle - reach)), math.floor(middle + reach) + 1)


def _lines_in(band: tuple[int, int]) -> int:
    """Number of lines that the squared envelope of a band has, that at 0 included."""
    return (band[1] - band[0]) // 2 + 1


def _products(spectra: ComplexArray) -> FloatArray:
    """Products that make up the squared envelope of a band, before the gains, shape (product, channel, sample).

    With bearing ``b`` and background ``n``, ``|b + n|^2 = |b|^2 + 2 Re(b n*) + |n|^2``. The products are ``|b|^2`` with and without
    the fault, ``2 Re(b n*)`` with and without it, and ``|n|^2``.
    """
    fault, healthy, background = ifft(spectra, next_fast_len(spectra.shape[-1]), norm="forward")
    bearing = np.stack([fault + healthy, healthy])
    return np.concatenate([_squared(bearing), 2 * (bearing * np.conj(background)).real, _squared(background)[None]])


def _squared(signal: ComplexArray) -> FloatArray:
    return signal.real**2 + signal.imag**2


@compiled_to_disk
def _stands_out(
    lines: ComplexArray, first: int, stop: int, bearing: float, background: float, margin: float, impulses: FloatArray
) -> bool:
    """Whether, in some channel, the largest searched line of the record exceeds that of the twin by ``margin`` times the rms of noise.

    ``lines`` has the shape (product, channel, line), those from ``first`` to ``stop`` are searched, and ``bearing`` and ``background`` are
    gains.
    """
    _, n_channels, n_lines = lines.shape
    twin = np.empty(n_lines)
    for channel in range(n_channels):
        highest = highest_of_twin = 0.0
        for line in range(n_lines):
            noise = background * background * lines[4, channel, line]
            healthy = bearing * (bearing * lines[1, channel, line] + background * lines[3, channel, line]) + noise
            twin[line] = abs(healthy)
            if first <= line < stop:
                faulty = bearing * (bearing * lines[0, channel, line] + background * lines[2, channel, line]) + noise
                highest, highest_of_twin = max(highest, abs(faulty)), max(highest_of_twin, twin[line])
        # the square of a line of noise has an exponential distribution, whose median is ln 2 of its mean
        floor = np.partition(twin, n_lines // 2)[n_lines // 2] / math.sqrt(math.log(2))
        if highest - highest_of_twin > margin * math.hypot(floor, background * background * impulses[channel]):
            return True
    return False


def _over_angle(signals: FloatArray, angles: FloatArray) -> FloatArray:
    """Signals of a band over the angle of the shaft, at even steps, shape (..., sample); ``angles`` are those of a whole record."""
    count, n = signals.shape[-1], len(angles)
    at = np.interp(np.arange(count) * (n / count), np.arange(n), angles)
    even = np.linspace(at[0], at[-1], count)
    return np.apply_along_axis(lambda row: np.interp(even, at, row), -1, signals)
