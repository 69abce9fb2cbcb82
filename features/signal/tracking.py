"""Course of the shaft speed of a recording, from the harmonics of the shaft alone, and how far it can be believed.

``low analytic signal -> path of the highest evidence -> course at the limit of the noise -> NaN where the evidence is noise``

The first course is a chain of chirps (`chirplets`), the second follows the likelihood of all harmonics (`refinement`).
One harmonic that stands above the noise is enough.

Limits: lines that move and are stronger than those of the shaft, such as those of another shaft or of a gear, are taken for
it. A line at a constant frequency, such as one of the mains, is disregarded if the shaft changes its speed; at a constant
speed the higher comb wins, and a single line of the shaft loses against a stronger one of the mains. Random vibration in a
band as narrow as a line, of a lightly damped resonance below five times the fastest speed, is taken for a line. A tacho has
none of these limits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from features.signal.chirplets import (
    HARMONICS,
    WEIGHTS,
    WINDOW_TURNS,
    ChirpPath,
    Search,
    baseband,
    clear_nearby,
    evidence_for,
    strongest_path,
)
from features.signal.door import Positive, Rows, checked
from features.signal.refinement import Course, deviations, refined
from features.signal.rows import BoolArray, ComplexArray, FloatArray, brief
from features.signal.steady_lines import without_steady_lines

EXTREMES = (0.05, 0.95)  # quantiles of a course
MOVED = 0.25  # difference between them, in slowest speeds, from which no line of the shaft is steady


class SpeedCourse(NamedTuple):
    """Shaft rate over a recording, NaN where the signal does not tell it."""

    rate: Rows
    """Shaft rate at each sample [Hz], shape (record, time)."""
    uncertainty: Rows
    """Standard deviation of the rate [Hz], shape (record, time)."""

    def __repr__(self) -> str:
        return brief(self)


@checked
def track_speed(
    x: Rows, fs: Positive, slowest: Positive, fastest: Positive, steepest: Positive | None = None
) -> SpeedCourse:
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
        Range of the shaft rate [Hz]. The narrower it is, the surer is the answer.
    steepest
        Largest change of the rate [Hz/s]; by default the whole range in a second.

    Raises
    ------
    ValueError
        For a range that is not ascending or reaches beyond the sample rate, or a signal that is too short.
    """
    if not slowest < fastest or (HARMONICS + 0.5) * fastest > fs / 2:
        raise ValueError(
            f"slowest, fastest: {slowest:g} and {fastest:g} Hz are no range below {fs / (2 * HARMONICS + 1):.4g} Hz, so that "
            f"{HARMONICS} harmonics lie below half the sample rate; give two ascending rates."
        )
    if x.shape[1] < 2 * WINDOW_TURNS / slowest * fs:
        raise ValueError(
            f"x: {x.shape[1] / fs:.3g} s are too short for a course of {slowest:g} Hz; give {2 * WINDOW_TURNS / slowest:.3g} s or more."
        )
    search = Search(slowest, fastest, fastest - slowest if steepest is None else steepest)
    courses = np.stack([_course(row, fs, search) for row in x.astype(float)])
    return SpeedCourse(courses[:, 0], courses[:, 1])


def _course(x: FloatArray, fs: float, search: Search) -> FloatArray:
    """Shaft rate of one record and its uncertainty at each sample [Hz], shape (2, time)."""
    z, rate = baseband(x, fs, (HARMONICS + 0.5) * search.fastest)
    z, path = _best_path(z, rate, search)
    if not path.is_clear():
        return np.full((2, len(x)), np.nan)
    course, time = refined(z, rate, path, search), np.arange(len(x)) / fs
    found = np.stack([course.at(time), np.interp(time, course.time, np.sqrt(course.variance))])
    middle, clear = _clear(z, rate, course, path, search.length)
    found[:, ~clear[np.searchsorted(0.5 * (middle[1:] + middle[:-1]), time)]] = np.nan
    return found


def _best_path(z: ComplexArray, rate: float, search: Search) -> tuple[ComplexArray, ChirpPath]:
    """Signal and its path: without steady lines, if its path is clear throughout and moves too far for lines of the shaft to be steady."""
    rest = without_steady_lines(z, rate, search.length)
    if not np.array_equal(rest, z):
        path = strongest_path(rest, rate, search)
        moved = np.ptp(np.quantile(path.rate, EXTREMES)) > MOVED * search.slowest
        if moved and clear_nearby(path.evidence, path.noise).all():
            return rest, path
    return z, strongest_path(z, rate, search)


def _clear(
    z: ComplexArray, rate: float, course: Course, path: ChirpPath, length: float
) -> tuple[FloatArray, BoolArray]:
    """Middle of windows [s], and whether there is clear evidence along a course around each; both of shape (window,)."""
    found = deviations(z, rate, course.at(np.arange(len(z)) / rate), path, length)
    return found.time, clear_nearby(evidence_for(found.power) @ WEIGHTS, 0.0)
