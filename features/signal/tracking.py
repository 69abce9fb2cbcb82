"""Course of the shaft speed of a recording, from the harmonics of the shaft alone, and how far it can be believed.

``spectra of short windows -> evidence of each speed -> path of least cost -> local polynomial -> NaN where it is noise``

The evidence of a speed in a window is the sum of the logarithms of the power at its harmonics over the usual power at each
frequency, so that several weak harmonics are worth more than one strong line of another source; many orders vote for one
speed as in [1]_. The path with the highest evidence, less the cost of its jumps, is found by dynamic programming [2]_.

The path is corrected a few times: along the course so far, the harmonics are demodulated to lines near zero, and the
parabola through their power at, above and below the course has its top at the speed. A local polynomial [3]_ smooths the
corrected course. Its width is chosen by the remaining error and the freedom that it has, so that a ramp is straight and a
modulation is kept.

Limits: a change of the speed by more than a sixth of the square of ``slowest`` in a second (4 Hz/s for 5 Hz) smears the
lines of a window, and the course may be wrong there. Lines that move and are stronger than those of the shaft, such as
those of another shaft or of a gear, are taken for it. A line at a constant frequency, such as one of the mains, is
disregarded if the speed changes by more than ``slowest`` (tried up to 27 dB above the shaft); otherwise, the higher comb
wins, and a single line of the shaft loses against a stronger one of the mains. Random vibration in a band as narrow as a
line, of a lightly damped resonance below five times the fastest speed, is taken for a line. A tacho has none of these
limits.

.. [1] Q. Leclere, H. Andre, J. Antoni, "A multi-order probabilistic approach for Instantaneous Angular Speed
       tracking: debriefing of the CMMNO'14 diagnosis contest", *Mech. Syst. Signal Process.* 81 (2016) 375-386.
.. [2] G. D. Forney, "The Viterbi algorithm", *Proc. IEEE* 61 (3) (1973) 268-278.
.. [3] A. Savitzky, M. J. E. Golay, "Smoothing and differentiation of data by simplified least squares procedures",
       *Anal. Chem.* 36 (8) (1964) 1627-1639.
"""

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.ndimage import median_filter, uniform_filter1d
from scipy.signal import resample, savgol_filter

from features.signal.arguments import as_records, check_positive, like
from features.signal.demodulation import running_median
from features.signal.rows import FloatArray, IntArray, brief
from gen.support.rounding import rounded_down, rounded_up

HARMONICS = np.c_[1:6]
WEIGHTS = HARMONICS[:, 0] ** -0.25  # of their evidence: a single line is rather the first harmonic than the second
TOP = 5.5  # highest frequency that is looked at, over the fastest speed
TURNS = 1.25  # of the slowest speed in a hop; four hops are a window
PADDING = 5  # bins of a spectrum over the resolution of a window
FAINTEST = 1e-6  # least power over the highest one
HALF = 4.0  # power over the usual one from which the evidence grows with its logarithm
JUMP = 0.02  # cost of a jump of the path by one bin, in evidence; a jump of more bins costs its square
NEARBY = 13  # windows that are judged together
LEAST = 1.75  # mean evidence that noise does not have, of many windows
SHORT = 8.0  # windows that raise it by one in a record of one window
SHARED = 10.0  # share of the noise that a local parabola keeps, times its width in windows, which overlap


class SpeedCourse(NamedTuple):
    """Shaft rate over a recording, NaN where the signal does not tell it."""

    rate: FloatArray
    """Shaft rate at each sample [Hz], shape (record, time)."""
    uncertainty: FloatArray
    """Standard deviation of the rate [Hz], one for each record, shape (record, time)."""

    def __repr__(self) -> str:
        return brief(self)


def track_speed(x: ArrayLike, fs: float, slowest: float, fastest: float) -> SpeedCourse:
    """Shaft rate at each sample [Hz] and its uncertainty, estimated from the harmonics of the shaft.

    A record in which no course stands out from noise is NaN throughout; a longer part without shaft harmonics, such as a
    silent one, is NaN. The uncertainty is that of the noise; it does not tell that other lines were taken for the shaft.

    Parameters
    ----------
    x
        Signals, shape (record, time), at least 16 turns of the slowest speed long.
    fs
        Sample rate [Hz].
    slowest, fastest
        Range of the shaft rate [Hz]. The narrower it is, the surer is the answer. The higher the slowest speed is, the
        shorter are the windows, and the faster may the speed change.

    Raises
    ------
    ValueError
        For a range that is not ascending or reaches beyond the sample rate, or a signal that is too short.
    """
    check_positive(fs=fs, slowest=slowest, fastest=fastest)
    records = as_records(x)
    duration = records.shape[1] / fs
    if not slowest < fastest or TOP * fastest > fs / 2:
        raise ValueError(
            f"slowest, fastest: {slowest:g} and {fastest:g} Hz are no range up to {rounded_down(fs / 2 / TOP)} Hz, so that "
            f"{len(HARMONICS)} harmonics lie below half the sample rate; give two ascending rates."
        )
    if duration < 16 / slowest:
        raise ValueError(
            f"x: {duration:.3g} s are too short for a course of {slowest:g} Hz; give {rounded_up(16 / slowest)} s or more."
        )
    rate, uncertainty = np.stack([_course(row, fs, slowest, fastest) for row in records], axis=1)
    return SpeedCourse(like(x, rate), like(x, uncertainty))


def _course(x: FloatArray, fs: float, slowest: float, fastest: float) -> FloatArray:
    """Shaft rate of one record and its uncertainty at each sample [Hz], shape (2, time).

    Speeds are in bins of the padded spectra, and times in samples of the signal that holds frequencies up to TOP alone.
    """
    count = round(2 * TOP * fastest / fs * len(x))
    y, rate = np.asarray(resample(x - x.mean(), count)), fs * count / len(x)
    hop = round(TURNS / slowest * rate)
    window = np.hanning(4 * hop + 1)
    size = PADDING * len(window)
    power = np.abs(np.fft.rfft(sliding_window_view(y, len(window))[::hop] * window, size)) ** 2
    power += FAINTEST * power.max() + 1e-300  # a silent record has a floor too
    candidates = np.arange(slowest * size / rate, fastest * size / rate).astype(int)
    centre, place = hop * np.arange(2, len(power) + 2), np.arange(len(x)) * count / len(x)
    # a line that stays at its frequency is usual in the first attempt, and stands out from frequencies nearby in the second
    usual = np.quantile(power, [0.25], axis=0)
    for shape in (usual, running_median(usual, 2 * candidates[:1], usual.size)):
        floor = np.outer(np.median(power / shape, axis=1), shape)
        rates = _path(WEIGHTS @ np.log1p(power / floor / HALF)[:, HARMONICS * candidates], candidates)
        for _ in (1, 2, 3, 4):  # corrections, each of a bin at most
            course = np.clip(CubicSpline(centre, rates)(np.arange(count)), *candidates[[0, -1]])
            rates, error, evidence = _corrected(y, course, centre, window, floor)
        nearby = median_filter(evidence, NEARBY)
        clear = evidence.mean() > LEAST + SHORT / len(evidence)
        if clear and nearby.min() > LEAST and np.ptp(rates) > candidates[0]:
            break
    told = np.broadcast_arrays(CubicSpline(centre, rates)(place), error)
    return np.where(clear & (np.interp(place, centre, nearby) > LEAST), told, np.nan) * rate / size


def _path(evidence: FloatArray, candidates: IntArray) -> IntArray:
    """Candidates with the highest evidence less the cost of jumps, (window,), from evidence of shape (window, candidate)."""
    cost = JUMP * np.subtract.outer(candidates, candidates) ** 2
    totals = [evidence[0]]
    for row in evidence[1:]:
        totals.append(row + (totals[-1] - cost).max(axis=1))
    path = [totals.pop().argmax()]
    for total in totals[::-1]:
        path.append((total - cost[path[-1]]).argmax())
    return candidates[path[::-1]]


def _corrected(
    y: FloatArray, course: FloatArray, centre: IntArray, window: FloatArray, floor: FloatArray
) -> tuple[FloatArray, float, FloatArray]:
    """Smooth course at the centres of the windows, its standard deviation, and the evidence of the course given."""
    turns = np.cumsum(course + np.c_[-1:2], axis=1) - course / 2
    lines = y * np.exp(-2j * np.pi / PADDING / len(window) * HARMONICS[..., None] * turns)
    sums = sliding_window_view(lines, len(window), axis=2)[:, :, :: len(window) // 4] @ window
    noise = floor[np.arange(len(floor)), np.rint(HARMONICS * course[centre]).astype(int)]
    power = np.abs(sums) ** 2 / noise[:, None]  # (harmonic, shift, window)
    # harmonics that do not stand out add noise alone; a parabola fits the logarithm of a line better than its power
    clear = uniform_filter1d(power[:, [1]], NEARBY) > HALF
    low, middle, high = np.log1p(np.sum(power * clear, axis=0))
    curvature = uniform_filter1d(2 * middle - low - high, NEARBY)
    rates = course[centre] + np.clip((high - low) / np.maximum(2 * curvature, 1e-9), -1, 1)
    widths = 1 + 2 ** np.arange(2, np.log2(len(rates))).astype(int)
    fits = np.array([savgol_filter(rates, width, 2) for width in widths])
    errors = np.std(rates - fits, axis=1)
    # a narrow polynomial leaves little, but keeps much of the noise
    best = np.argmin(errors * np.exp(SHARED / widths))
    return fits[best], errors[best] * np.sqrt(SHARED / widths[best]), WEIGHTS @ np.log1p(power[:, 1] / HALF)
