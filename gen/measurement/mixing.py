"""Bearing and background of a record: modulation by the shaft, spectral lines of the machine, and their mean products.

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

BLOCK = 256  # samples; all work arrays of a block fit the first-level cache


class Lines(NamedTuple):
    """Modulations and spectral lines of one record. A line is ``c cos(angle) - s sin(angle)``, given by its parts ``c`` and ``s``."""

    modulations: FloatArray
    """Parts of the modulation once and twice per turn, of the noise and of each path, shape (1 + channel, 4)."""
    harmonics: FloatArray
    """Parts of each multiple of the shaft angle, shape (channel, order, 2)."""
    growth: FloatArray
    """Factor of the harmonics at each sample, shape (time,); empty if it is 1 throughout."""
    tones: FloatArray
    """Angle per sample and at the first sample, and parts of the modulation by the shaft, shape (tone, 4)."""
    tone_parts: FloatArray
    """Parts of each tone, shape (channel, tone, 2)."""


class Products(NamedTuple):
    """Mean products over a record, all channels together, of fault (d), healthy bearing (h) and background (n)."""

    dd: float
    hh: float
    nn: float
    dh: float
    dn: float
    hn: float


@compiled_to_disk
def mix(
    fault: Float32Array,
    healthy: Float32Array,
    background: Float32Array,
    impulses: Float32Array,
    angles: FloatArray,
    lines: Lines,
    first: int,
    stop: int,
) -> Products:
    """Modulate bearing and noise, and add impulses and lines to the noise, all in place; return the mean products of the three.

    Parameters
    ----------
    fault : array, shape (channel, time), or (0, 0) for none
        What the fault adds to the vibration of the bearing behind the path [m s-2].
    healthy, background : array, shape (channel, time)
        Vibration of the bearing without the fault [m s-2], and noise of the machine [1]. All are changed from sample ``first`` to ``stop``.
    impulses : array, shape (channel, time) or (0, 0)
        Impulses and knocks of the machine behind the path, if there are any [1].
    angles : array, shape (time,)
        Angle of the shaft [rad].
    lines : Lines
        What the machine adds, and its modulations.
    """
    turn = np.empty((2, BLOCK), np.float32)  # cosine and sine of the shaft angle
    tables = np.empty((len(lines.tones), 2, BLOCK), np.float32)
    for tone in range(len(lines.tones)):
        _advance(lines.tones[tone, 0], tables[tone])
    modulations = lines.modulations.astype(np.float32)
    real, imaginary, gain = np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32)
    sums = np.zeros((6, BLOCK), np.float32)
    for start in range(first, stop, BLOCK):
        size = min(BLOCK, stop - start)
        _turn_block(angles, start, size, turn)
        for channel in range(len(healthy)):
            _sum_harmonics(lines, channel, start, size, turn, real, imaginary)
            _add_tones(lines, channel, tables, start, size, turn, real)
            if len(impulses) > 0:
                for j in range(size):
                    real[j] += impulses[channel, start + j]
            _modulation(turn, modulations[0], gain)
            for j in range(size):
                background[channel, start + j] = background[channel, start + j] * gain[j] + real[j]
            _modulation(turn, modulations[1 + channel], gain)
            for j in range(size):
                h, n = healthy[channel, start + j] * gain[j], background[channel, start + j]
                healthy[channel, start + j] = h
                sums[1, j] += h * h
                sums[2, j] += n * n
                sums[5, j] += h * n
            if len(fault) > 0:
                for j in range(size):
                    h, n = healthy[channel, start + j], background[channel, start + j]
                    d = fault[channel, start + j] * gain[j]
                    fault[channel, start + j] = d
                    sums[0, j] += d * d
                    sums[3, j] += d * h
                    sums[4, j] += d * n
    means = np.zeros(6)
    for row in range(6):
        for j in range(BLOCK):
            means[row] += sums[row, j]
    means /= len(healthy) * (stop - first)
    return Products(means[0], means[1], means[2], means[3], means[4], means[5])


@njit(**INLINE)
def _turn_block(angles: FloatArray, start: int, size: int, turn: Float32Array) -> None:
    """Cosine and sine of the shaft angle for the block from sample ``start`` on, into ``turn``, shape (2, BLOCK).

    From those of half the angle, less whole turns, because the series of :func:`cosine` is for angles up to a quarter of a turn.
    """
    for j in range(size):
        x = angles[start + j]
        half = 0.5 * (x - 2 * math.pi * math.floor(x * (0.5 / math.pi) + 0.5))
        c, s = cosine(half), sine(half)
        turn[0, j], turn[1, j] = c * c - s * s, 2 * c * s


@njit(**INLINE)
def _sum_harmonics(
    lines: Lines, channel: int, start: int, size: int, turn: Float32Array, real: Float32Array, imaginary: Float32Array
) -> None:
    """Sum of the harmonics of the shaft in a block, into ``real``, by Horner's rule in ``exp(i angle)``."""
    real[:] = 0.0
    imaginary[:] = 0.0
    for order in range(lines.harmonics.shape[1] - 1, -1, -1):
        a, b = np.float32(lines.harmonics[channel, order, 0]), np.float32(lines.harmonics[channel, order, 1])
        for j in range(size):
            x, y = real[j] + a, imaginary[j] + b
            real[j] = x * turn[0, j] - y * turn[1, j]
            imaginary[j] = x * turn[1, j] + y * turn[0, j]
    if len(lines.growth) > 0:
        for j in range(size):
            real[j] *= np.float32(lines.growth[start + j])


@njit(**INLINE)
def _add_tones(
    lines: Lines, channel: int, tables: Float32Array, start: int, size: int, turn: Float32Array, real: Float32Array
) -> None:
    """Add the tones of the machine, modulated by the shaft, to ``real``."""
    for tone in range(len(lines.tones)):
        step, at_first, once_c, once_s = lines.tones[tone]
        x, y = lines.tone_parts[channel, tone]
        angle = at_first + start * step
        c, s = math.cos(angle), math.sin(angle)
        p, q = np.float32(x * c - y * s), np.float32(x * s + y * c)
        a, b = np.float32(once_c), np.float32(once_s)
        for j in range(size):
            wave = p * tables[tone, 0, j] - q * tables[tone, 1, j]
            real[j] += wave * (np.float32(1) + a * turn[0, j] - b * turn[1, j])


@njit(**INLINE)
def _advance(step: float, table: Float32Array) -> None:
    """Cosine and sine of ``step`` times 0, 1, ..., into ``table``, shape (2, BLOCK)."""
    c, s = math.cos(step), math.sin(step)
    x, y = 1.0, 0.0
    for j in range(BLOCK):
        table[0, j], table[1, j] = x, y
        x, y = x * c - y * s, x * s + y * c


@njit(**INLINE)
def _modulation(turn: Float32Array, parts: Float32Array, gain: Float32Array) -> None:
    """Gain with modulation once and twice per turn of the shaft, into ``gain``, shape (BLOCK,) [1]."""
    for j in range(BLOCK):
        c, s = turn[0, j], turn[1, j]
        once = parts[0] * c - parts[1] * s
        twice = parts[2] * (c * c - s * s) - parts[3] * (c * s + c * s)
        gain[j] = np.float32(1) + once + twice
