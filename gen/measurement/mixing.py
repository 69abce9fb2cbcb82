"""A record put together from its parts: modulations that follow the shaft, lines of the machine, and the power of either side.

The parts come filtered; what is left is cheap to do sample by sample and dear array by array. Phases of the lines are exact at the
start of every block of samples and turn by complex multiplication within it. Nothing is fused and no sum depends on the width of the
vectors: the bits are the same on every machine.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]

BLOCK = 256  # samples that stay in the first-level cache with all that is done to them


class Shaft(NamedTuple):
    """How the shaft turns: evenly from ``start`` by ``step`` [rad per sample], or by ``angles``, shape (time,) or empty [rad]."""

    start: float
    step: float
    angles: FloatArray


class Lines(NamedTuple):
    """What repeats with the shaft or by itself, in one record; every phase is that at the first sample [rad]."""

    swings: FloatArray
    """Depths of modulation once and twice per turn and their phases, of the noise and of each channel's path, shape (1 + channel, 4)."""
    harmonics: FloatArray
    """Amplitude and phase of each multiple of the shaft rate, shape (order, 2)."""
    tones: FloatArray
    """Angle per sample, amplitude, depth of modulation by the shaft, phase of the tone and of the modulation, shape (tone, 5)."""


@njit(cache=True, nogil=True, error_model="numpy")
def mix(
    bearing: Float32Array,
    background: Float32Array,
    ringing: Float32Array,
    shaft: Shaft,
    lines: Lines,
    first: int,
    stop: int,
) -> tuple[float, float]:
    """Modulate the bearing, make the noise the whole background, both in place, and return the rms of each.

    Parameters
    ----------
    bearing, background : array, shape (channel, time)
        What came through the path [m s-2], and the noise [1]; worked on from ``first`` to ``stop``.
    ringing : array, shape (channel, time) or (0, 0)
        Impulses and knocks of the machine, if there are any [1].
    shaft, lines
        How the shaft turns, and what the machine sounds like beside its noise.
    """
    n_channels = len(bearing)
    turn = np.empty((2, BLOCK), np.float32)  # cosine and sine of the shaft angle
    within = np.empty((2, BLOCK))  # of the angle since the start of the block
    tables = np.empty((len(lines.tones), 2, BLOCK), np.float32)
    for tone in range(len(lines.tones)):
        _turn_on(lines.tones[tone, 0], within)
        tables[tone] = within
    _turn_on(shaft.step, within)
    swings = np.empty((n_channels + 1, 4), np.float32)
    for row in range(n_channels + 1):
        for order in range(2):
            depth, phase = lines.swings[row, order], lines.swings[row, 2 + order]
            swings[row, 2 * order], swings[row, 2 * order + 1] = depth * math.cos(phase), depth * math.sin(phase)
    real, imaginary, gain = np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32)
    powers = np.zeros((2, BLOCK), np.float32)
    for start in range(first, stop, BLOCK):
        size = min(BLOCK, stop - start)
        if len(shaft.angles) > 0:
            for j in range(size):
                turn[0, j], turn[1, j] = math.cos(shaft.angles[start + j]), math.sin(shaft.angles[start + j])
        else:
            c, s = math.cos(shaft.start + start * shaft.step), math.sin(shaft.start + start * shaft.step)
            for j in range(BLOCK):
                turn[0, j] = c * within[0, j] - s * within[1, j]
                turn[1, j] = s * within[0, j] + c * within[1, j]
        real[:] = 0.0
        imaginary[:] = 0.0
        for order in range(len(lines.harmonics) - 1, -1, -1):  # Horner in e^(i turn)
            amplitude, phase = lines.harmonics[order]
            a, b = np.float32(amplitude * math.cos(phase)), np.float32(amplitude * math.sin(phase))
            for j in range(size):
                x, y = real[j] + a, imaginary[j] + b
                real[j] = x * turn[0, j] - y * turn[1, j]
                imaginary[j] = x * turn[1, j] + y * turn[0, j]
        for tone in range(len(lines.tones)):
            step, amplitude, depth, phase, swing = lines.tones[tone]
            angle = phase + start * step
            c, s = np.float32(amplitude * math.cos(angle)), np.float32(amplitude * math.sin(angle))
            a, b = np.float32(depth * math.cos(swing)), np.float32(depth * math.sin(swing))
            for j in range(size):
                wave = c * tables[tone, 0, j] - s * tables[tone, 1, j]
                real[j] += wave * (np.float32(1) + a * turn[0, j] - b * turn[1, j])
        for channel in range(n_channels):
            _swing(turn, swings[1 + channel], gain)
            for j in range(size):
                value = bearing[channel, start + j] * gain[j]
                bearing[channel, start + j] = value
                powers[0, j] += value * value
            _swing(turn, swings[0], gain)
            for j in range(size):
                value = background[channel, start + j] * gain[j] + real[j]
                if len(ringing) > 0:
                    value += ringing[channel, start + j]
                background[channel, start + j] = value
                powers[1, j] += value * value
    heard, other = 0.0, 0.0
    for j in range(BLOCK):
        heard += powers[0, j]
        other += powers[1, j]
    n = n_channels * (stop - first)
    return math.sqrt(heard / n), math.sqrt(other / n)


@njit(forceinline=True, error_model="numpy")
def _turn_on(step: float, table: FloatArray) -> None:
    """Cosine and sine of ``step`` times 0, 1, ..., shape (2, BLOCK)."""
    c, s = math.cos(step), math.sin(step)
    x, y = 1.0, 0.0
    for j in range(BLOCK):
        table[0, j], table[1, j] = x, y
        x, y = x * c - y * s, x * s + y * c


@njit(forceinline=True, error_model="numpy")
def _swing(turn: Float32Array, swing: Float32Array, gain: Float32Array) -> None:
    """Gain that swings once and twice per shaft turn, shape (BLOCK,)."""
    for j in range(BLOCK):
        c, s = turn[0, j], turn[1, j]
        once = swing[0] * c - swing[1] * s
        twice = swing[2] * (c * c - s * s) - swing[3] * (c * s + c * s)
        gain[j] = np.float32(1) + once + twice
