"""Computed order tracking: signals sampled at equal angles of the shaft instead of at equal times.

``shaft rates or tacho -> angle of every sample -> samples at equal angles -> order spectrum, map``

The time at which the shaft has turned by a given angle is interpolated from the angles of the samples, and the signal is
taken there by interpolation with a windowed sinc function [1]_. The function is also the anti-alias filter: its cut-off
is half the lower one of the two sample rates, at every instant. A line at order k of the shaft then lies at order k at
any speed.

.. [1] K. R. Fyfe, E. D. S. Munck, "Analysis of computed order tracking", *Mechanical Systems and Signal Processing*
       11 (2) (1997) 187-205.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from features.signal.arguments import as_records, check_positive, check_whole, like
from features.signal.demodulation import amplitude_spectrum
from features.signal.rows import FloatArray, brief, row_kernel

CROSSINGS = 32  # zero crossings of the sinc function to each side
BETA = 8.0  # of the Kaiser window: orders above half the samples per turn are 80 dB down
PASS_SHARE = 0.92  # -6 dB point over half the lower sample rate; flat within 0.1 % up to 0.84 of it
TABLE_STEPS = 512  # table values from one zero crossing to the next; linear between them, which errs by 5e-6


class OrderMap(NamedTuple):
    """Order spectra of windows that overlap by half."""

    turns: FloatArray
    """Middle of each window [turns after the first sample], shape (window,)."""
    orders: FloatArray
    """Shape (order,)."""
    amplitude: FloatArray
    """Amplitudes in the unit of the signals, shape (record, window, order)."""

    def __repr__(self) -> str:
        return brief(self)


def resample_to_orders(
    x: FloatArray, fs: FloatArray | float, shaft_rate: FloatArray, per_turn: int, count: int
) -> FloatArray:
    """Samples at equal angles of a shaft of constant speed, shape (record, time) to (record, ``count``).

    Sample k is at k / ``per_turn`` turns after the first sample of the record. A record counts as zero outside its
    time, so the first and last 32 samples (of the lower sample rate) contain less of it. In single precision.

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
    intervals = np.repeat(np.broadcast_to(interval, len(x))[:, None], count, axis=1)
    return _interpolate(x, np.arange(count) * intervals, intervals, _kernel_table())


def resample_to_angle(x: ArrayLike, angle: ArrayLike, per_turn: int) -> FloatArray:
    """Samples at equal angles of a shaft of any speed, shape (record, time) to (record, turns * ``per_turn``).

    The first sample is at the first angle of the record that is a whole number of turns. All records have as many whole
    turns as the one with the fewest. A record counts as zero outside its time, so the first and last 32 samples (of the
    lower sample rate) contain less of it. In single precision.

    Parameters
    ----------
    x
        Signals, shape (record, time).
    angle
        Angle of the shaft at each sample [rad], ascending, shape (record, time) or (1, time) for all records.
    per_turn
        Samples per turn of the shaft. Orders above half of it are removed.

    Raises
    ------
    ValueError
        If an angle does not ascend or is not finite, or a record has no whole turn.
    """
    check_whole(per_turn=per_turn)
    records, angles = as_records(x), as_records(angle, "angle")
    if angles.shape not in (records.shape, (1, records.shape[1])):
        raise ValueError(f"angle: an array of shape {angles.shape} does not suit records of shape {records.shape}.")
    turns = np.broadcast_to(angles.astype(float) / (2 * np.pi), records.shape)
    wrong = np.flatnonzero(~(np.diff(turns, axis=1) > 0).all(axis=1))
    if len(wrong):
        raise ValueError(
            f"angle: that of record {wrong[0]} does not ascend; give the angle since the start, in radians."
        )
    first = np.ceil(turns[:, 0] - 1e-9)
    whole = int(np.min(turns[:, -1] - first) + 1e-9)
    if per_turn < 2 or whole < 1:
        raise ValueError(f"{whole} turns of {per_turn} samples are no signal; give a whole turn, and per_turn above 1.")
    at, time = np.arange(whole * per_turn) / per_turn, np.arange(records.shape[1], dtype=float)
    place = np.stack([np.interp(start + at, of_record, time) for start, of_record in zip(first, turns, strict=True)])
    return like(x, _interpolate(records, place, np.gradient(place, axis=1), _kernel_table()))


def angles_from_speed(shaft_rate: ArrayLike, fs: float) -> FloatArray:
    """Angle of the shaft at each sample [rad], 0 at the first, from its rate at each sample [Hz]; both (record, time)."""
    check_positive(fs=fs)
    rate = as_records(shaft_rate, "shaft_rate").astype(float, copy=False)
    angle = np.zeros(rate.shape)
    np.cumsum((rate[:, 1:] + rate[:, :-1]) * (np.pi / fs), axis=1, out=angle[:, 1:])
    return like(shaft_rate, angle)


def order_spectrum(y: ArrayLike, per_turn: int) -> tuple[FloatArray, FloatArray]:
    """Orders, shape (order,), and amplitude spectrum of resampled signals, shape (record, order).

    As `features.signal.demodulation.envelope_spectrum`: a sine of amplitude a gives a line of height a, and the grid is
    four times finer than one over the number of turns.

    Parameters
    ----------
    y
        Signals at equal angles, shape (record, angle), as from `resample_to_angle`.
    per_turn
        Samples per turn.
    """
    check_whole(per_turn=per_turn)
    orders, amplitude = amplitude_spectrum(as_records(y, "y"), per_turn)
    return orders, like(y, amplitude)


def order_map(y: ArrayLike, per_turn: int, turns: int = 16) -> OrderMap:
    """Order spectra of windows of some turns, which overlap by half: a waterfall in which lines of the shaft stand still.

    Parameters
    ----------
    y
        Signals at equal angles, shape (record, angle), as from `resample_to_angle`.
    per_turn
        Samples per turn.
    turns
        Length of a window [turns]; lines closer than 2 / ``turns`` orders are not separated.

    Raises
    ------
    ValueError
        If the signals are shorter than a window.
    """
    check_whole(per_turn=per_turn, turns=turns)
    signals, length = as_records(y, "y"), per_turn * turns
    if signals.shape[1] < length:
        told = f"{signals.shape[1] / per_turn:.3g} turns are less than a window of {turns}"
        raise ValueError(f"y: {told}; give fewer turns.")
    step = max(length // 2, 1)
    windows = np.lib.stride_tricks.sliding_window_view(signals, length, axis=1)[:, ::step]
    orders, amplitude = amplitude_spectrum(windows.reshape(-1, length), per_turn)
    middle = 0.5 * turns + np.arange(windows.shape[1]) * step / per_turn
    return OrderMap(middle, orders, like(y, amplitude.reshape(*windows.shape[:2], -1)))


@lru_cache(1)
def _kernel_table() -> FloatArray:
    """Right half of the windowed sinc function, at steps of 1 / TABLE_STEPS of a zero crossing; ends in two zeros."""
    u = np.arange(CROSSINGS * TABLE_STEPS + 2) / TABLE_STEPS
    window = np.i0(BETA * np.sqrt(np.maximum(1 - (u / CROSSINGS) ** 2, 0))) / np.i0(BETA)
    return np.where(u < CROSSINGS, PASS_SHARE * np.sinc(PASS_SHARE * u) * window, 0.0)


@row_kernel
def _interpolate(x: FloatArray, place: FloatArray, interval: FloatArray, table: FloatArray) -> FloatArray:
    """Signals at places [samples], with the distance of neighbouring places there [samples], all (record, angle)."""
    out = np.zeros(place.shape, np.float32)
    slopes = table[1:] - table[:-1]
    for row in range(place.shape[0]):
        for k in range(place.shape[1]):
            cutoff = min(1.0, 1.0 / interval[row, k])
            reach = CROSSINGS / cutoff
            first = max(0, int(np.ceil(place[row, k] - reach)))
            last = min(x.shape[1] - 1, int(np.floor(place[row, k] + reach)))
            value = 0.0
            for n in range(first, last + 1):
                u = abs(n - place[row, k]) * cutoff * TABLE_STEPS
                i = np.uint32(u)  # indices with a sign are checked for negative ones, which takes a quarter more time
                value += x[row, n] * (table[i] + (u - i) * slopes[i])
            out[row, k] = cutoff * value
    return out
