"""Detection of faults of any class: against their width, and against false alarms.

A faulty record is detected if a class other than healthy is predicted. The share that is detected of the faults of about the same width
has the interval of Clopper and Pearson [1]_. Records of one specimen are correlated, so a specimen counts as one trial, however many
records it has. The curve against false alarms is the receiver operating characteristic of healthy against faulty.

.. [1] C. J. Clopper, E. S. Pearson, "The use of confidence or fiducial limits illustrated in the case of the binomial", *Biometrika* 26
       (1934) 404-413.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import beta

from features.baselines.records import FloatArray, IntArray
from features.baselines.tracks import ranges

BINS = 8  # of width
RESAMPLES = 200
INTERVAL = (0.025, 0.975)  # quantiles of a 95 % interval
FALSE_ALARMS = np.array([0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1])


@dataclass(frozen=True)
class WidthBin:
    """Faulty records whose widths lie in one interval.

    Attributes
    ----------
    records, specimens
        Their number, and that of their specimens.
    width
        Mean width [m].
    detected, low, high
        Share that is detected, and its 95 % interval.
    """

    records: int
    specimens: int
    width: float
    detected: float
    low: float
    high: float


@dataclass(frozen=True)
class Roc:
    """Receiver operating characteristic of healthy against faulty, by the probability that a record is not healthy.

    Attributes
    ----------
    area, interval
        Area under the curve, and its 95 % bootstrap interval over specimens; None if one kind has only one specimen.
    false_alarms
        Shares of the healthy records.
    detected, low, high
        Largest share of the faulty records that is detected at no more than these false alarms, and its interval, empty
        where ``interval`` is None.
    """

    area: float
    interval: tuple[float, float] | None
    false_alarms: tuple[float, ...]
    detected: tuple[float, ...]
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()


def detection(detected: np.ndarray, width: FloatArray, specimen: IntArray) -> tuple[WidthBin, ...]:
    """Detection of faulty records by their width [m], all of shape (record,); empty if no width is known."""
    with_width = width > 0
    if not with_width.any():
        return ()
    detected, width, specimen = detected[with_width], width[with_width], specimen[with_width]
    number = ranges(width, BINS)
    return tuple(
        _width_bin(detected[held], width[held], specimen[held]) for held in (number == k for k in np.unique(number))
    )


def _width_bin(detected: np.ndarray, width: FloatArray, specimen: IntArray) -> WidthBin:
    share, trials = float(detected.mean()), len(np.unique(specimen))
    hits, misses = share * trials, (1 - share) * trials
    low = float(beta.ppf(INTERVAL[0], hits, misses + 1)) if hits > 0 else 0.0
    high = float(beta.ppf(INTERVAL[1], hits + 1, misses)) if misses > 0 else 1.0
    return WidthBin(len(detected), trials, float(width.mean()), share, low, high)


def roc(faulty: np.ndarray, score: FloatArray, specimen: IntArray, seed: int) -> Roc | None:
    """Receiver operating characteristic of records by a score of being faulty, all of shape (record,); None for one kind.

    The specimens of each kind are resampled apart.
    """
    if faulty.all() or not faulty.any():
        return None

    falling = np.argsort(-score)
    ends = np.flatnonzero(np.diff(score[falling], append=np.nan))  # records of one score are told apart by no threshold

    def curve(weight: FloatArray) -> FloatArray:
        """Area, and shares at `FALSE_ALARMS`, of weighted records: `sklearn.metrics.roc_curve` takes ten times as long."""
        sums = [np.append(0.0, np.cumsum((weight * kind)[falling])[ends]) for kind in (faulty, ~faulty)]
        hits, alarms = (of / of[-1] for of in sums)
        # the curve is a staircase: at a share of false alarms, the hits reached so far
        return np.append(np.trapezoid(hits, alarms), hits[np.searchsorted(alarms, FALSE_ALARMS, side="right") - 1])

    area, *detected = curve(np.ones(len(score))).tolist()
    shares = tuple(FALSE_ALARMS.tolist())
    # records of one specimen are alike, so the bootstrap draws specimens
    rng, weight = np.random.default_rng(seed), np.empty(len(score))
    kinds = [(kind, *np.unique(specimen[kind], return_inverse=True)) for kind in (faulty, ~faulty)]
    # of one specimen every draw is the same, and there is no interval
    if min(len(units) for _, units, _ in kinds) < 2:
        return Roc(area, None, shares, tuple(detected))
    curves = np.empty((RESAMPLES, 1 + len(FALSE_ALARMS)))
    for drawn in curves:
        for kind, units, number in kinds:
            times = np.bincount(rng.integers(len(units), size=len(units)), minlength=len(units))
            weight[kind] = times[number]
        drawn[:] = curve(weight)
    (least, *low), (most, *high) = np.quantile(curves, INTERVAL, axis=0).tolist()
    return Roc(area, (least, most), shares, tuple(detected), tuple(low), tuple(high))
