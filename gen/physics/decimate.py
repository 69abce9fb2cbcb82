"""From the rate of the steps down to the sample rate: linear-phase low-passes over lanes, in two stages where that is cheaper.

The first stage comes down to twice the sample rate with a short filter, for what it lets through above the band the second, sharp one
still takes out [1]_. Each pass over the history serves four outputs, so that the sums are bound by arithmetic and not by memory.

.. [1] R. E. Crochiere, L. R. Rabiner, *Multirate Digital Signal Processing*, Prentice-Hall, 1983, chapter 5.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.signal import firwin

from gen.physics.lanes import INLINE, LANES, fma, lane_count, wide

FloatArray = NDArray[np.float64]

HALF_TAPS = 34  # samples on either side of an output; with beta 7.857 at least 80 dB from 1.025 Nyquist on
FIRST_HALF_TAPS = 6  # of the first stage, in its outputs: 80 dB from 1.4 times the sample rate on, flat to half of it
OUTPUTS = 4  # of a pass over the history
BETA = 7.857  # of the Kaiser windows


class Stage(NamedTuple):
    """A low-pass and how many of its inputs there are to an output."""

    taps: FloatArray
    """Shape (input, output) for ``OUTPUTS`` successive outputs, zero where an output does not reach."""
    factor: int
    kept: int
    """Inputs that an output needs before its newest."""


NO_STAGE = Stage(np.empty((0, OUTPUTS)), 1, 0)


class Decimation(NamedTuple):
    """Filters from ``n_steps`` per sample to one; with a single stage the ``first`` has no taps."""

    first: Stage
    last: Stage


def decimation(n_steps: int) -> Decimation:
    """Low-passes for ``n_steps`` steps per sample.

    The last one cuts off at 0.875 of the new Nyquist frequency with a transition of 0.15 of it (Kaiser window, 80 dB).
    """
    if n_steps == 1:
        return Decimation(NO_STAGE, _stage(np.ones(1), 1))
    factor = 2 if n_steps % 2 == 0 and n_steps > 2 else n_steps
    last = _low_pass(HALF_TAPS, factor, 0.875 / factor)
    if factor == n_steps:
        return Decimation(NO_STAGE, _stage(last, factor))
    ratio = n_steps // 2
    return Decimation(_stage(_low_pass(FIRST_HALF_TAPS, ratio, 0.96 / ratio), ratio), _stage(last, factor))


def lead_knots(n_steps: int) -> int:
    """Samples by which an output lags its newest input."""
    if n_steps == 1:
        return 0
    return HALF_TAPS + (FIRST_HALF_TAPS // 2 if n_steps % 2 == 0 and n_steps > 2 else 0)


def _low_pass(half_taps: int, factor: int, cutoff: float) -> FloatArray:
    return firwin(2 * half_taps * factor + 1, cutoff, window=("kaiser", BETA))


def _stage(taps: FloatArray, factor: int) -> Stage:
    rows = len(taps) + (OUTPUTS - 1) * factor
    shifted = np.zeros((rows + -rows % 4, OUTPUTS))
    for output in range(OUTPUTS):
        shifted[output * factor : output * factor + len(taps), output] = taps
    return Stage(shifted, factor, len(taps) - 1)


@njit(**INLINE)
def filter_rows(taps: FloatArray, history: FloatArray, first: int, channels: int, out: FloatArray, at: int, total: FloatArray) -> None:
    """Four rows of ``out`` from row ``at`` on: weighted sums of the rows of ``history`` from row ``first`` on.

    A row is as long as ``channels * LANES``; ``total`` is a work array of four rows of one channel.
    """
    wide()
    for channel in range(channels):
        for i in range(OUTPUTS * lane_count()):
            total[i] = 0.0
        for row in range(0, len(taps), 4):
            a0, b0, c0, d0 = taps[row, 0], taps[row, 1], taps[row, 2], taps[row, 3]
            a1, b1, c1, d1 = taps[row + 1, 0], taps[row + 1, 1], taps[row + 1, 2], taps[row + 1, 3]
            a2, b2, c2, d2 = taps[row + 2, 0], taps[row + 2, 1], taps[row + 2, 2], taps[row + 2, 3]
            a3, b3, c3, d3 = taps[row + 3, 0], taps[row + 3, 1], taps[row + 3, 2], taps[row + 3, 3]
            source, stride = ((first + row) * channels + channel) * LANES, channels * LANES
            # views, since numba would look at every index whether it counts from the end
            ws, xs = history[source:], history[source + stride :]
            ys, zs = history[source + 2 * stride :], history[source + 3 * stride :]
            for lane in range(lane_count()):
                w, x, y, z = ws[lane], xs[lane], ys[lane], zs[lane]
                total[lane] = fma(a0, w, fma(a1, x, fma(a2, y, fma(a3, z, total[lane]))))
                total[LANES + lane] = fma(b0, w, fma(b1, x, fma(b2, y, fma(b3, z, total[LANES + lane]))))
                total[2 * LANES + lane] = fma(c0, w, fma(c1, x, fma(c2, y, fma(c3, z, total[2 * LANES + lane]))))
                total[3 * LANES + lane] = fma(d0, w, fma(d1, x, fma(d2, y, fma(d3, z, total[3 * LANES + lane]))))
        for output in range(OUTPUTS):
            for lane in range(lane_count()):
                out[((at + output) * channels + channel) * LANES + lane] = total[output * LANES + lane]
