"""Angle of a shaft from the pulses of a tacho, with the pulses that it missed.

``tacho -> places of the pulses -> their numbers, missed ones counted -> angle of every sample``

The intervals of a steady shaft change little from one pulse to the next, also in a run-up. One that is near a whole multiple
of the interval beside it holds pulses that were missed. Anything else is refused, because one wrong pulse bends the angle of
the whole record.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.ndimage import median_filter

from features.signal.arguments import as_records, check_finite, check_whole, like
from features.signal.rows import FloatArray, IntArray, row_kernel

REARMED = 0.1  # of the range of a tacho, by which it must fall below the threshold before it counts again
NEARBY = 9  # intervals whose median is the usual one
STEADY = 1.5  # ratio of an interval to the one beside it, below which no pulse was missed
NEAR_WHOLE = 1.15  # ratio to a whole multiple of it, below which pulses were missed
MOST_MISSED = 0.25  # of all pulses
MOST_BEYOND = 2  # intervals before the first and after the last pulse


def angles_from_tacho(tacho: ArrayLike, pulses_per_turn: int = 1, threshold: float | None = None) -> FloatArray:
    """Angle of the shaft at each sample [rad], 0 at the first pulse, shape (record, time).

    A pulse is where the tacho rises through the threshold, interpolated linearly between two samples. A cubic spline
    joins the angles of the pulses; before the first and after the last one the speed is constant, for two intervals at
    most. Pulses that were missed are counted: an interval within 15 % of a whole multiple of the one beside it has them,
    one within a factor of 1.5 has not. Missed pulses are up to a quarter of all.

    Parameters
    ----------
    tacho
        Signals of a tachometer or keyphasor, shape (record, time). One that rises through the threshold again counts
        only after it has fallen below it by a tenth of its range, so that noise gives no pulses.
    pulses_per_turn
        Pulses in a turn of the shaft, at equal angles; those of a wheel with missing teeth as if it were whole.
    threshold
        In the unit of the tacho; by default the middle of the range of each record.

    Raises
    ------
    ValueError
        If a record has fewer than two pulses, begins or ends with more than two intervals without one, or has pulses that
        are neither at equal angles nor plainly missed ones.
    """
    check_whole(pulses_per_turn=pulses_per_turn)
    signals = as_records(tacho, "tacho").astype(float, copy=False)
    low, high = signals.min(axis=1), signals.max(axis=1)
    level = 0.5 * (low + high)
    if threshold is not None:
        check_finite(threshold=threshold)
        level[:] = threshold
    time, angle = np.arange(signals.shape[1], dtype=float), np.empty(signals.shape)
    for row, signal in enumerate(signals):
        pulses = _pulses(signal, level[row], level[row] - REARMED * (high[row] - low[row]))
        if len(pulses) < 2:
            raise ValueError(
                f"tacho: record {row} has {len(pulses)} pulses above {level[row]:.4g}; give two or more, or a threshold."
            )
        course = CubicSpline(pulses, 2 * np.pi / pulses_per_turn * _pulse_numbers(pulses, pulses_per_turn, row))
        first, last = int(np.ceil(pulses[0])), int(pulses[-1]) + 1
        angle[row, first:last] = course(time[first:last])
        for beyond, end in ((slice(0, first), pulses[0]), (slice(last, None), pulses[-1])):
            angle[row, beyond] = course(end) + course(end, 1) * (time[beyond] - end)
        ends = {f"before sample {pulses[0]:.0f}": -angle[row, 0]}
        ends[f"after sample {pulses[-1]:.0f}"] = angle[row, -1] - course(pulses[-1])
        silent = [place for place, turned in ends.items() if turned > MOST_BEYOND * 2 * np.pi / pulses_per_turn]
        if silent:
            raise ValueError(f"tacho: record {row} has no pulse {' and '.join(silent)}; cut off what lies there.")
    return like(tacho, angle)


@row_kernel
def _pulses(signal: FloatArray, threshold: float, rearmed: float) -> FloatArray:
    """Places at which a signal rises through a threshold after it was below another one, in samples, shape (pulse,)."""
    places = np.empty(len(signal))
    count, armed = 0, signal[0] < threshold
    for n in range(1, len(signal)):
        if armed and signal[n] >= threshold:
            places[count] = n - (signal[n] - threshold) / (signal[n] - signal[n - 1])
            count += 1
            armed = False
        elif signal[n] < rearmed:
            armed = True
    return places[:count]


def _pulse_numbers(pulses: FloatArray, pulses_per_turn: int, record: int) -> IntArray:
    """Number of each pulse, from 0 and with the missed ones counted, shape (pulse,), from its place [samples]."""
    steps = _steps(pulses, record)
    numbers = np.append(0, np.cumsum(steps))
    missed = numbers[-1] - len(steps)
    if missed > MOST_MISSED * numbers[-1]:
        raise ValueError(
            f"tacho: record {record} misses {missed} of {numbers[-1]} pulses, or its marks are not at equal angles; give a tacho with "
            "marks at equal angles that misses fewer."
        )
    # a gap in each turn of most of the record belongs to the wheel
    apart = np.diff(numbers[:-1][steps > 1])
    teeth = int(np.median(apart)) if len(apart) > 1 else pulses_per_turn
    if teeth % pulses_per_turn and np.count_nonzero(apart == teeth) * teeth > numbers[-1] / 2:
        raise ValueError(
            f"tacho: record {record} has a gap every {teeth} pulses, as a wheel with missing teeth; give pulses_per_turn={teeth}."
        )
    return numbers


def _steps(pulses: FloatArray, record: int) -> IntArray:
    """By how much the number of each pulse grows to the next one, shape (interval,): 1 where none was missed."""
    intervals = np.diff(pulses)
    steps = np.ones(len(intervals), np.intp)
    # begin at an interval like the median of those nearby: no pulse was missed in it, and none was too many
    first = int(np.abs(np.log(intervals / median_filter(intervals, NEARBY, mode="mirror"))).argmin())
    # compare each interval with the one beside it, towards both ends of the record
    for places in (range(first + 1, len(intervals)), range(first - 1, -1, -1)):
        beside = intervals[first]
        for place in places:
            ratio = intervals[place] / beside
            steps[place] = max(1, round(ratio))
            beside = intervals[place] / steps[place]
            change, most = ratio / steps[place], STEADY if steps[place] == 1 else NEAR_WHOLE
            if not 1 / most < change < most:
                raise ValueError(
                    f"tacho: record {record} has an interval of {ratio:.3g} times the one beside it, from sample {pulses[place]:.0f} on, "
                    "which is neither steady nor of missed pulses; give a threshold that each mark passes once, or leave that part out."
                )
    return steps
