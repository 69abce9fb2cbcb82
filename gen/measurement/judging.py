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

import functools
import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.fft import ifft, next_fast_len, rfft

from gen.measurement.gains import Gains, rms_of
from gen.measurement.mixing import Parts
from gen.physics.kernel.compiling import compiled_to_disk

FloatArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]
Complex64Array = NDArray[np.complex64]

FALSE_ALARM = 1e-3
BANDS = 4  # of equal width up to half the sample rate, searched beside the whole
HARMONICS = 3
TOLERANCE = 0.01  # of a fault order, beyond one line of the spectrum: slip and ball motion widen a line
LOWEST = 2  # lines of a Hann window beside that of the mean
WINDOW_RMS = math.sqrt(3 / 8)  # of a Hann window
AROUND = 32  # lines on either side of a searched window that tell its floor
SIGNIFICANT_RISE = 1.25  # of the rms by a fault without lines: ISO 20816-1:2016, criterion II
_LEAST_SAMPLES = 16  # of a band
Judge = Callable[[Gains], bool]
"""Tells for any gains of bearing and background whether the fault of a record can be seen."""


def judges_of(records: Sequence[Parts]) -> list[Judge]:
    """Judges of records of one length; they are transformed side by side, which takes a third of the time.

    A fault without lines can be seen if it raises the rms significantly.
    """
    lined = [parts for parts in records if parts.orders]
    spectra = iter(rfft(np.stack([parts.signals for parts in lined])) if lined else ())
    return [_judge_of_lines(parts, next(spectra)) if parts.orders else _judge_of_rise(parts) for parts in records]


def _judge_of_rise(parts: Parts) -> Judge:
    def sees(gains: Gains) -> bool:
        bearing, background = gains
        rest = rms_of(parts.products, 0.0, bearing, background)
        return rms_of(parts.products, bearing, bearing, background) >= SIGNIFICANT_RISE * rest

    return sees


def _judge_of_lines(parts: Parts, spectra: ComplexArray) -> Judge:
    """Judge that looks for every damaged part in each band of each channel; a band is transformed once, when it is needed.

    ``spectra`` are those of the ``signals``, shape (part, channel, frequency).
    """
    n = parts.signals.shape[2]
    # lines stand at orders: bins are counted in turns of the shaft
    turns = (parts.angles[-1] - parts.angles[0]) / (2 * math.pi) * n / (n - 1)
    searched = [
        (band, part, first, stop)
        for band in bands_of(n)
        for part, order in enumerate(parts.orders)
        for first, stop in (_window(harmonic * order * turns) for harmonic in range(1, HARMONICS + 1))
        if first < stop <= (band[1] - band[0]) // 2 + 1  # lines of the squared envelope of the band, that at 0 included
    ]
    n_lines = parts.signals.shape[1] * sum(stop - first for *_, first, stop in searched)
    # one bound for all lines, bands and channels of the search
    margin = math.sqrt(2 * math.log(max(n_lines, 1) / FALSE_ALARM))
    lines_of = functools.cache(lambda band: _lines(parts, spectra[..., slice(*band)], band))

    def sees(gains: Gains) -> bool:
        seen: set[int] = set()
        for band, part, *window in searched:
            # a part that was seen in one band needs no other
            if part not in seen and _stands_out(*lines_of(band), *window, *gains, margin):
                seen.add(part)
        # every damaged part must be seen
        return len(seen) == len(parts.orders)

    return sees


def _window(middle: float) -> tuple[int, int]:
    """First line within the tolerance of ``middle`` cycles per record, and the line after the last one."""
    reach = 1 + TOLERANCE * middle
    return max(LOWEST, math.ceil(middle - reach)), math.floor(middle + reach) + 1


def bands_of(n: int) -> list[tuple[int, int]]:
    """First frequency of each band and the one after its last, for ``n`` samples: all frequencies, then their quarters."""
    half = n // 2
    every = [(1, half), *((max(1, half * k // BANDS), half * (k + 1) // BANDS) for k in range(BANDS))]
    return [(low, high) for low, high in every if high - low >= _LEAST_SAMPLES]


def _lines(parts: Parts, spectra: ComplexArray, band: tuple[int, int]) -> tuple[Complex64Array, FloatArray]:
    """Lines of the squared envelope of a band before the gains, and rms of the lines of impulses at random times.

    Shapes (product, channel, line), of the products of :func:`_products`, and (channel,).
    """
    products = _products(spectra)
    if not parts.steady:
        products = _over_angle(products, parts.angles)
    # the window takes out the step from the end of a record to its start, which the transforms join
    lines = rfft(products * _hann(products.shape[-1]))
    # step in frequency of ``impulses`` over that of the record
    share = parts.signals.shape[2] / 2 / (parts.impulses.shape[1] - 1)
    impulses = parts.impulses[:, round(band[0] / share) : round(band[1] / share)].sum(axis=1)
    # of one type each, for which the comparison is compiled once
    return lines.astype(np.complex64), (WINDOW_RMS * products.shape[-1] * share**1.5 * impulses).astype(np.float64)


@functools.lru_cache(maxsize=16)
def _hann(size: int) -> FloatArray:
    return np.hanning(size).astype(np.float32)


def _products(spectra: ComplexArray) -> FloatArray:
    """Products that make up the squared envelope of a band, before the gains, shape (product, channel, sample).

    With bearing ``b`` and background ``n``, ``|b + n|^2 = |b|^2 + 2 Re(b n*) + |n|^2``. The products are ``|b|^2`` with and without
    the fault, ``2 Re(b n*)`` with and without it, and ``|n|^2``.
    """
    background, healthy, fault = ifft(spectra, next_fast_len(spectra.shape[-1]), norm="forward")
    bearing = np.stack([fault + healthy, healthy])
    return np.concatenate([_squared(bearing), 2 * (bearing * np.conj(background)).real, _squared(background)[None]])


def _squared(signal: ComplexArray) -> FloatArray:
    return signal.real**2 + signal.imag**2


@compiled_to_disk
def _stands_out(
    lines: Complex64Array, impulses: FloatArray, first: int, stop: int, b: float, n: float, margin: float
) -> bool:
    """Whether, in some channel, the largest searched line of the record exceeds that of the twin by ``margin`` times the rms of noise.

    ``lines`` has the shape (product, channel, line), those from ``first`` to ``stop`` are searched, and ``b`` and ``n`` are the gains of
    bearing and background.
    """
    around = max(LOWEST, first - AROUND), min(lines.shape[2], stop + AROUND)
    twin = np.empty(around[1] - around[0])
    for channel in range(lines.shape[1]):
        highest = highest_of_twin = 0.0
        for line in range(around[0], around[1]):
            # lines of bearing and background add with the gains, without a new transform
            noise = n * n * lines[4, channel, line]
            healthy = abs(b * (b * lines[1, channel, line] + n * lines[3, channel, line]) + noise)
            twin[line - around[0]] = healthy
            if first <= line < stop:
                faulty = abs(b * (b * lines[0, channel, line] + n * lines[2, channel, line]) + noise)
                highest, highest_of_twin = max(highest, faulty), max(highest_of_twin, healthy)
        # the square of a line of noise has an exponential distribution, whose median is ln 2 of its mean
        floor = np.partition(twin, len(twin) // 2)[len(twin) // 2] / math.sqrt(math.log(2))
        if highest - highest_of_twin > margin * math.hypot(floor, n * n * impulses[channel]):
            return True
    return False


def compile_judging() -> None:
    """Compile the comparison of lines, or fetch it from numba's cache on disk."""
    _stands_out(np.zeros((5, 1, 4), np.complex64), np.zeros(1), 2, 3, 1.0, 1.0, 1.0)


def _over_angle(signals: FloatArray, angles: FloatArray) -> FloatArray:
    """Signals of a band over the angle of the shaft, at even steps, shape (..., sample); ``angles`` are those of a whole record."""
    count, n = signals.shape[-1], len(angles)
    at = np.interp(np.arange(count) * (n / count), np.arange(n), angles)
    even = np.linspace(at[0], at[-1], count)
    return np.apply_along_axis(lambda row: np.interp(even, at, row), -1, signals)
