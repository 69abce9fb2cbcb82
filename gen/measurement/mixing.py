"""Bearing and background of a record: modulation by the shaft, spectral lines of the machine, and the rms of each.

The inputs are filtered already. What is left is fast sample by sample and slow array by array. Phases of the lines are exact at the start
of every block of samples and advance by complex multiplication within it. No operation is fused and no sum depends on the width of the
vectors, so the bits are the same on every machine.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]

BLOCK = 256  # samples; all work arrays of a block fit the first-level cache


class ShaftAngle(NamedTuple):
    """Angle of the shaft: from ``start`` [rad] by ``step`` [rad per sample], or ``angles``, shape (time,) or empty [rad]."""

    start: float
    step: float
    angles: FloatArray


class Lines(NamedTuple):
    """Modulations and spectral lines of one record; every phase is that at the first sample [rad]."""

    modulations: FloatArray
    """Depth of modulation once and twice per turn and the phases of both, of the noise and of each path, shape (1 + channel, 4)."""
    harmonics: FloatArray
    """Amplitude and phase of each multiple of the shaft rate, shape (order, 2)."""
    tones: FloatArray
    """Angle per sample, amplitude, depth of modulation by the shaft, phase of the tone and of the modulation, shape (tone, 5)."""


@njit(cache=True, nogil=True, error_model="numpy")
def mix(
    bearing: Float32Array,
    background: Float32Array,
    impulses: Float32Array,
    shaft: ShaftAngle,
    lines: Lines,
    first: int,
    stop: int,
) -> tuple[float, float]:
    """Modulate bearing and noise, and add impulses and lines to the noise, both in place; return the rms of each [m s-2, 1].

    Parameters
    ----------
    bearing, background : array, shape (channel, time)
        Vibration of the bearing behind the path [m s-2], and noise of the machine [1]; changed from sample ``first`` to ``stop``.
    impulses : array, shape (channel, time) or (0, 0)
        Impulses and knocks of the machine behind the path, if there are any [1].
    shaft, lines
        Angle of the shaft, and the lines and modulations that the machine adds.
    """
    n_channels = len(bearing)
    turn = np.empty((2, BLOCK), np.float32)  # cosine and sine of the shaft angle
    within = np.empty((2, BLOCK))  # of the angle since the start of the block
    tables = np.empty((len(lines.tones), 2, BLOCK), np.float32)
    for tone in range(len(lines.tones)):
        _advance(lines.tones[tone, 0], within)
        tables[tone] = within
    _advance(shaft.step, within)
    modulations = np.empty((n_channels + 1, 4), np.float32)
    for row in range(n_channels + 1):
        for order in range(2):
            depth, phase = lines.modulations[row, order], lines.modulations[row, 2 + order]
            modulations[row, 2 * order], modulations[row, 2 * order + 1] = (
                depth * math.cos(phase),
                depth * math.sin(phase),
            )
    real, imaginary, gain = np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32)
    powers = np.zeros((2, BLOCK), np.float32)
    for start in range(first, stop, BLOCK):
        size = min(BLOCK, stop - start)
        _turn_block(shaft, start, size, within, turn)
        _sum_harmonics(lines, size, turn, real, imaginary)
        _add_tones(lines, tables, start, size, turn, real)
        for channel in range(n_channels):
            _modulation(turn, modulations[1 + channel], gain)
            for j in range(size):
                value = bearing[channel, start + j] * gain[j]
                bearing[channel, start + j] = value
                powers[0, j] += value * value
            _modulation(turn, modulations[0], gain)
            for j in range(size):
                value = background[channel, start + j] * gain[j] + real[j]
                if len(impulses) > 0:
                    value += impulses[channel, start + j]
                background[channel, start + j] = value
                powers[1, j] += value * value
    of_bearing, of_background = 0.0, 0.0
    for j in range(BLOCK):
        of_bearing += powers[0, j]
        of_background += powers[1, j]
    n = n_channels * (stop - first)
    return math.sqrt(of_bearing / n), math.sqrt(of_background / n)


@njit(forceinline=True, error_model="numpy")
def _turn_block(shaft: ShaftAngle, start: int, size: int, within: FloatArray, turn: Float32Array) -> None:
    """Cosine and sine of the shaft angle for the block from sample ``start`` on, into ``turn``, shape (2, BLOCK)."""
    if len(shaft.angles) > 0:
        for j in range(size):
            turn[0, j], turn[1, j] = math.cos(shaft.angles[start + j]), math.sin(shaft.angles[start + j])
    else:
        c, s = math.cos(shaft.start + start * shaft.step), math.sin(shaft.start + start * shaft.step)
        for j in range(BLOCK):
            turn[0, j] = c * within[0, j] - s * within[1, j]
            turn[1, j] = s * within[0, j] + c * within[1, j]


@njit(forceinline=True, error_model="numpy")
def _sum_harmonics(lines: Lines, size: int, turn: Float32Array, real: Float32Array, imaginary: Float32Array) -> None:
    """Sum of the harmonics of the shaft in a block, into ``real``, by Horner's rule in ``exp(i angle)``."""
    real[:] = 0.0
    imaginary[:] = 0.0
    for order in range(len(lines.harmonics) - 1, -1, -1):
        amplitude, phase = lines.harmonics[order]
        a, b = np.float32(amplitude * math.cos(phase)), np.float32(amplitude * math.sin(phase))
        for j in range(size):
            x, y = real[j] + a, imaginary[j] + b
            real[j] = x * turn[0, j] - y * turn[1, j]
            imaginary[j] = x * turn[1, j] + y * turn[0, j]


@njit(forceinline=True, error_model="numpy")
def _add_tones(
    lines: Lines, tables: Float32Array, start: int, size: int, turn: Float32Array, real: Float32Array
) -> None:
    """Add the tones of the machine, modulated by the shaft, to ``real``."""
    for tone in range(len(lines.tones)):
        step, amplitude, depth, phase, modulation = lines.tones[tone]
        angle = phase + start * step
        c, s = np.float32(amplitude * math.cos(angle)), np.float32(amplitude * math.sin(angle))
        a, b = np.float32(depth * math.cos(modulation)), np.float32(depth * math.sin(modulation))
        for j in range(size):
            wave = c * tables[tone, 0, j] - s * tables[tone, 1, j]
            real[j] += wave * (np.float32(1) + a * turn[0, j] - b * turn[1, j])


@njit(forceinline=True, error_model="numpy")
def _advance(step: float, table: FloatArray) -> None:
    """Cosine and sine of ``step`` times 0, 1, ..., into ``table``, shape (2, BLOCK)."""
    c, s = math.cos(step), math.sin(step)
    x, y = 1.0, 0.0
    for j in range(BLOCK):
        table[0, j], table[1, j] = x, y
        x, y = x * c - y * s, x * s + y * c


@njit(forceinline=True, error_model="numpy")
def _modulation(turn: Float32Array, depths: Float32Array, gain: Float32Array) -> None:
    """Gain with modulation once and twice per turn of the shaft, into ``gain``, shape (BLOCK,) [1]."""
    for j in range(BLOCK):
        c, s = turn[0, j], turn[1, j]
        once = depths[0] * c - depths[1] * s
        twice = depths[2] * (c * c - s * s) - depths[3] * (c * s + c * s)
        gain[j] = np.float32(1) + once + twice
