"""Bearing and background of a record: modulation by the shaft, tones of the machine, and their mean products.

The inputs are filtered already. What is left is fast sample by sample and slow array by array. Only explicit multiply-adds are fused and
no sum depends on the width of the vectors, so the bits are the same on every machine.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gen.physics.kernel.compiling import INLINE, compiled_to_disk, cosine, sine

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
ComplexArray = NDArray[np.complexfloating]
Complex64Array = NDArray[np.complex64]

BLOCK = 256  # samples; all work arrays of a block fit the first-level cache


class Lines(NamedTuple):
    """Modulations and tones of one record. A line of the complex amplitude ``c`` is ``Re(c exp(i angle))``."""

    modulations: ComplexArray
    """Modulation of the noise and of each path once and twice per turn of the shaft, shape (1 + channel, 2) [1]."""
    amplitudes: ComplexArray
    """Of the tones, shape (channel, tone)."""
    steps: FloatArray
    """Angle per sample of each tone, shape (tone,) [rad]."""
    phases: FloatArray
    """Angle of each tone at the first sample, shape (tone,) [rad]."""
    tone_modulations: ComplexArray
    """Modulation of each tone once per turn of the shaft, shape (tone,) [1]."""


class Parts(NamedTuple):
    """Background and bearing of one record before their gains."""

    signals: Float32Array
    """Background [1], vibration of the bearing without the fault, and what the fault adds if that is known [m s-2], shape (part, channel,
    time).
    """
    products: tuple[float, ...]
    """Mean products over the record, all channels together: nn, hn, hh, dn, dh, dd of background (n), healthy bearing (h) and fault (d)."""
    impulses: Float32Array
    """Rms of the lines that impulses at random times make in squared envelopes, by the frequency of the impulses from 0 to half the sample
    rate, shape (channel, frequency) [1].
    """
    orders: tuple[float, ...]
    """Order of the shaft at which the fault of each damaged part repeats [1]; empty for faults without lines."""
    angles: FloatArray
    """Angle of the shaft, shape (time,) [rad]."""
    steady: bool
    """True if the speed is nearly constant, so that lines in frequency are lines in order."""


@compiled_to_disk
def mix(signals: Float32Array, others: Float32Array, angles: FloatArray, lines: Lines, kept: slice) -> FloatArray:
    """Modulate noise and bearing, and add the other sources and the lines to the noise, in place; return their mean products.

    Parameters
    ----------
    signals : array, shape (part, channel, time)
        Noise of the machine [1], and vibration of the bearing behind the path without the fault, then what the fault adds if that is known
        [m s-2]. They are changed in the samples ``kept`` alone.
    others : array, shape (channel, time)
        Other sources in the machine behind the path, which are not modulated [1].
    angles : array, shape (time,)
        Angle of the shaft [rad].
    lines : Lines
        What the machine adds, and its modulations.
    kept : slice
        Samples of the record, behind the lead.
    """
    turn = np.zeros(BLOCK, np.complex64)
    machine, sums = np.empty(BLOCK, np.float32), np.zeros((6, BLOCK), np.float32)
    tables = np.empty((len(lines.steps), BLOCK), np.complex64)
    # each tone has a table of its turn over a block, so that no sample needs a sine
    for tone, step in enumerate(lines.steps):
        _advance(step, tables[tone])
    # block by block, so that all of it stays in the cache of the processor
    for start in range(kept.start, kept.stop, BLOCK):
        stop = min(start + BLOCK, kept.stop)
        _turn_block(angles[start:stop], turn)
        for channel in range(signals.shape[1]):
            machine[:] = 0.0
            _add_tones(lines, lines.amplitudes[channel], start, turn, tables, machine)
            for part in range(len(signals)):
                _modulate(lines.modulations[1 + channel if part > 0 else 0], turn, signals[part, channel, start:stop])
            for j in range(stop - start):
                signals[0, channel, start + j] += machine[j] + others[channel, start + j]
            # mean products of the parts: from them every gain gives its power
            row = 0
            for part in range(len(signals)):
                for other in range(part + 1):
                    _add_product(signals[part, channel, start:stop], signals[other, channel, start:stop], sums[row])
                    row += 1
    means = np.zeros(6)
    for row in range(6):
        for j in range(BLOCK):
            means[row] += sums[row, j]
    return means / (signals.shape[1] * (kept.stop - kept.start))


@njit(**INLINE)
def _turn_block(angles: FloatArray, turn: Complex64Array) -> None:
    """``exp(i angle)`` of the shaft at the samples of a block, into ``turn``, shape (BLOCK,).

    From half the angle, less whole turns, because the series of :func:`cosine` is for angles up to a quarter of a turn.
    """
    for j in range(len(angles)):
        half = 0.5 * (angles[j] - 2 * math.pi * math.floor(angles[j] * (0.5 / math.pi) + 0.5))
        turn[j] = complex(cosine(half), sine(half)) ** 2


@njit(**INLINE)
def _add_tones(
    lines: Lines,
    amplitudes: ComplexArray,
    start: int,
    turn: Complex64Array,
    tables: Complex64Array,
    machine: Float32Array,
) -> None:
    """Add the tones of the machine, modulated by the shaft, to ``machine``, shape (BLOCK,)."""
    for tone, step in enumerate(lines.steps):
        angle = lines.phases[tone] + start * step
        amplitude = np.complex64(amplitudes[tone] * complex(math.cos(angle), math.sin(angle)))
        depth = np.complex64(lines.tone_modulations[tone])
        for j in range(BLOCK):
            machine[j] += (amplitude * tables[tone, j]).real * (np.float32(1) + (depth * turn[j]).real)


@njit(**INLINE)
def _advance(step: float, table: Complex64Array) -> None:
    """``exp(i step k)`` for ``k`` = 0, 1, ..., into ``table``, shape (BLOCK,)."""
    turned, turn = complex(1.0, 0.0), complex(math.cos(step), math.sin(step))
    for j in range(BLOCK):
        table[j] = turned
        turned *= turn


@njit(**INLINE)
def _modulate(depths: ComplexArray, turn: Complex64Array, signal: Float32Array) -> None:
    """Modulate a signal once and twice per turn of the shaft, in place."""
    once, twice = np.complex64(depths[0]), np.complex64(depths[1])
    for j in range(len(signal)):
        signal[j] *= np.float32(1) + (once * turn[j]).real + (twice * (turn[j] * turn[j])).real


@njit(**INLINE)
def _add_product(signal: Float32Array, other: Float32Array, sums: Float32Array) -> None:
    for j in range(len(signal)):
        sums[j] += signal[j] * other[j]
