"""Computed order tracking: signals sampled at equal angles of the shaft instead of at equal times.

A sample at angle a [turns] is taken at the time a / shaft_rate, by interpolation with a windowed sinc function [1]_. The
function is also the anti-alias filter: its cut-off is half the lower one of the two sample rates. A line at order k of
the shaft then lies at order k at any speed.

.. [1] K. R. Fyfe, E. D. S. Munck, "Analysis of computed order tracking", *Mechanical Systems and Signal Processing*
       11 (2), 1997.
"""

from functools import lru_cache

import numpy as np

from features.signal.rows import FloatArray, row_kernel

CROSSINGS = 32  # zero crossings of the sinc function to each side
BETA = 8.0  # of the Kaiser window: orders above half the samples per turn are 80 dB down
PASS_SHARE = 0.92  # -6 dB point over half the lower sample rate; flat within 0.1 % up to 0.84 of it
TABLE_STEPS = 512  # table values from one zero crossing to the next; linear between them, which errs by 5e-6


def resample_to_orders(
    x: FloatArray, fs: FloatArray | float, shaft_rate: FloatArray, per_turn: int, count: int
) -> FloatArray:
    """Samples at equal angles of the shaft, shape (record, time) to (record, ``count``), in single precision.

    Sample k is at k / ``per_turn`` turns after the first sample of the record. A record counts as zero outside its
    time, so the first and last 32 samples (of the lower sample rate) contain less of it.

    Parameters
    ----------
    x
        Signals, shape (record, time).
    fs
        Sample rate [Hz], of all records or of each, shape (record,).
    shaft_rate
        Constant shaft rate of each record [Hz], shape (record,).
    per_turn
        Samples per turn of the shaft.
    count
        Number of samples of each resampled record.
    """
    interval = np.asarray(fs, dtype=float) / (np.asarray(shaft_rate, dtype=float) * per_turn)
    return _interpolate(x, interval, count, _kernel_table())


@lru_cache(1)
def _kernel_table() -> FloatArray:
    """Right half of the windowed sinc function, at steps of 1 / TABLE_STEPS of a zero crossing; ends in two zeros."""
    u = np.arange(CROSSINGS * TABLE_STEPS + 2) / TABLE_STEPS
    window = np.i0(BETA * np.sqrt(np.maximum(1 - (u / CROSSINGS) ** 2, 0))) / np.i0(BETA)
    return np.where(u < CROSSINGS, PASS_SHARE * np.sinc(PASS_SHARE * u) * window, 0.0)


@row_kernel
def _interpolate(x: FloatArray, interval: FloatArray, count: int, table: FloatArray) -> FloatArray:
    """Signals at multiples of an interval, in samples of the signal, that each record has for itself."""
    out = np.zeros((len(x), count), np.float32)
    for row in range(len(x)):
        cutoff = min(1.0, 1.0 / interval[row])
        reach = CROSSINGS / cutoff
        for k in range(count):
            place = k * interval[row]
            first = max(0, int(np.ceil(place - reach)))
            last = min(x.shape[1] - 1, int(np.floor(place + reach)))
            value = 0.0
            for n in range(first, last + 1):
                u = abs(n - place) * cutoff * TABLE_STEPS
                i = int(u)
                value += x[row, n] * (table[i] + (u - i) * (table[i + 1] - table[i]))
            out[row, k] = cutoff * value
    return out
