"""Decimation from the rate of the steps to the sample rate: linear-phase low-pass filters over lanes, in two stages where that is faster.

The first stage decimates to twice the sample rate with a short filter; the second, sharp filter removes what the first leaves above the
band [1]_. Each row of the history that is loaded is added to four outputs, so that arithmetic and not memory limits the speed. Single
precision takes half the time, and its rounding is 120 dB below the largest input.

Kaiser windows [2]_ need 105 taps for the second stage; equiripple taps of the same attenuation and flatness are 91, which would save less
than a hundredth of the time of the kernel.

.. [1] R. E. Crochiere, L. R. Rabiner, *Multirate Digital Signal Processing*, Prentice-Hall, 1983, chapter 5.
.. [2] J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function", *Proc. IEEE Int. Symp. Circuits and Systems*,
       1974, 20-23.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.fft import rfft

from gen.physics.kernel.compiling import INLINE, LANES, fma, lane_count, wide

FloatArray = NDArray[np.floating]
Single = NDArray[np.float32]

HALF_TAPS = 26  # samples on each side of an output
FIRST_HALF_TAPS = (
    6  # of the first stage, in its outputs: 80 dB of attenuation above 1.4 times the sample rate, flat up to half of it
)
LAG = HALF_TAPS + FIRST_HALF_TAPS // 2  # samples by which an output lags its newest input, at most
OUTPUTS = 4  # to which the rows that are loaded are added
BETA = 7.857  # of the Kaiser windows
_GRID = 16384  # lines of the tabulated gain, up to four times the Nyquist frequency


class Stage(NamedTuple):
    """A low-pass filter and its decimation factor."""

    taps: Single
    """Shape (input, output) for ``OUTPUTS`` successive outputs, zero where an input does not contribute to an output."""
    factor: int
    kept: int
    """Inputs before the newest one that an output needs."""


NO_STAGE = Stage(np.empty((0, OUTPUTS), np.float32), 1, 0)


class Decimation(NamedTuple):
    """Filters from ``n_steps`` per sample to one; with a single stage ``first`` has no taps."""

    first: Stage
    last: Stage


def decimation(n_steps: int) -> Decimation:
    """Low-pass filters for ``n_steps`` steps per sample.

    Together they are flat below 0.8 of the new Nyquist frequency, and attenuate by 80 dB everything that would alias into a record. With
    one step per sample nothing can alias, and nothing is filtered.
    """
    if n_steps == 1:
        return Decimation(NO_STAGE, _stage(np.ones(1), 1))
    factor = 2 if n_steps % 2 == 0 and n_steps > 2 else n_steps
    last = _low_pass(HALF_TAPS, factor, 0.9 / factor)
    if factor == n_steps:
        return Decimation(NO_STAGE, _stage(last, factor))
    ratio = n_steps // 2
    return Decimation(_stage(_low_pass(FIRST_HALF_TAPS, ratio, 0.96 / ratio), ratio), _stage(last, factor))


def pass_band(share: FloatArray) -> FloatArray:
    """Gain of the sharp filter at a ``share`` of the Nyquist frequency, from 0 to 1, of its shape [1].

    In this form, what is computed at the sample rate passes the filter that the motion of the bodies passes in the kernel.
    """
    taps = _low_pass(HALF_TAPS, 2, 0.45)
    gains = np.abs(rfft(taps, _GRID))[: _GRID // 4 + 1]
    return np.interp(share, np.linspace(0, 1, len(gains)), gains)


def _low_pass(half_taps: int, factor: int, cutoff: float) -> NDArray[np.float64]:
    """Low-pass filter up to ``cutoff`` Nyquist frequencies, as ``scipy.signal.firwin`` designs it, which takes half a second to load."""
    samples = np.arange(-half_taps * factor, half_taps * factor + 1)
    taps = np.sinc(cutoff * samples) * np.kaiser(len(samples), BETA)
    return taps / taps.sum()


def _stage(taps: NDArray[np.float64], factor: int) -> Stage:
    rows = len(taps) + (OUTPUTS - 1) * factor
    shifted = np.zeros((rows + -rows % 4, OUTPUTS), np.float32)
    for output in range(OUTPUTS):
        shifted[output * factor : output * factor + len(taps), output] = taps
    return Stage(shifted, factor, len(taps) - 1)


@njit(**INLINE)
def filter_rows(
    stage: Stage,
    n_outputs: int,
    history: Single,
    first: int,
    out: Single,
    at: int,
    total: Single,
) -> None:
    """Compute ``n_outputs`` rows of ``out``, from row ``at`` on: weighted sums of the rows of ``history`` from row ``first`` on.

    A row has all lanes of one channel; ``total`` is a work array of ``n_outputs`` rows, a multiple of ``OUTPUTS``. The innermost loop adds
    four rows to four outputs. One outside it goes through all outputs before the next taps are read: the sums of four outputs alone would
    wait for each other, and take twice as long.
    """
    wide()
    taps = stage.taps
    for i in range(n_outputs * lane_count(LANES)):
        total[i] = 0.0
    for row in range(0, len(taps), 4):
        a0, b0, c0, d0 = taps[row, 0], taps[row, 1], taps[row, 2], taps[row, 3]
        a1, b1, c1, d1 = taps[row + 1, 0], taps[row + 1, 1], taps[row + 1, 2], taps[row + 1, 3]
        a2, b2, c2, d2 = taps[row + 2, 0], taps[row + 2, 1], taps[row + 2, 2], taps[row + 2, 3]
        a3, b3, c3, d3 = taps[row + 3, 0], taps[row + 3, 1], taps[row + 3, 2], taps[row + 3, 3]
        for output in range(0, n_outputs, OUTPUTS):
            rows, sums = history[(first + row + output * stage.factor) * LANES :], total[output * LANES :]
            for i in range(LANES):  # a constant length, so that the loop has no remainder
                w, x, y, z = rows[i], rows[LANES + i], rows[2 * LANES + i], rows[3 * LANES + i]
                sums[i] = fma(a0, w, fma(a1, x, fma(a2, y, fma(a3, z, sums[i]))))
                sums[LANES + i] = fma(b0, w, fma(b1, x, fma(b2, y, fma(b3, z, sums[LANES + i]))))
                sums[2 * LANES + i] = fma(c0, w, fma(c1, x, fma(c2, y, fma(c3, z, sums[2 * LANES + i]))))
                sums[3 * LANES + i] = fma(d0, w, fma(d1, x, fma(d2, y, fma(d3, z, sums[3 * LANES + i]))))
    outputs = out[at * LANES :]
    for i in range(n_outputs * lane_count(LANES)):
        outputs[i] = total[i]
