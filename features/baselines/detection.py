"""Detection of faults of any class: against their width, and against false alarms.

A faulty record is detected if a class other than healthy is predicted. The probability of detection follows the hit/miss
model of [1]_, ``logit(probability) = intercept + slope ln(width / mm)``, fitted by maximum likelihood. Records of one
specimen are correlated, so the covariance of the fit is that of clusters [2]_, the specimens. The curve against false
alarms is the receiver operating characteristic of healthy against faulty.

.. [1] MIL-HDBK-1823A, *Nondestructive Evaluation System Reliability Assessment*, US Department of Defense, 2009, appendix G.
.. [2] K.-Y. Liang, S. L. Zeger, "Longitudinal data analysis using generalized linear models", *Biometrika* 73 (1986) 13-22.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import expit, logit
from scipy.stats import t as student
from sklearn.linear_model import LogisticRegression

from features.baselines.records import FloatArray, IntArray
from features.baselines.tracks import ranges

BINS = 8  # of width
DETECTED = 0.9  # share of the widths a90 and a90/95
CONFIDENCE = 0.95  # of one edge of the band
RESAMPLES = 200
INTERVAL = (0.025, 0.975)  # quantiles of a 95 % interval
FALSE_ALARMS = np.array([0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1])


@dataclass(frozen=True)
class WidthBin:
    """Faulty records whose widths lie in one interval: their number, mean width [m], and share that is detected."""

    records: int
    width: float
    detected: float


@dataclass(frozen=True)
class DetectionFit:
    """Fitted probability of detection.

    Attributes
    ----------
    intercept, slope
        Of the logit over the logarithm of the width in millimetres.
    covariance
        Variance of the intercept, covariance of both, and variance of the slope.
    quantile
        Student's t for 95 % on one side, with two degrees of freedom fewer than specimens.
    a90, a90_95
        Width [m] at which 90 % are detected, and at which the lower edge of the band is 90 %; None outside the tested
        widths.
    """

    intercept: float
    slope: float
    covariance: tuple[float, float, float]
    quantile: float
    a90: float | None
    a90_95: float | None

    def band(self, width: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Lower edge, probability of detection, and upper edge at some widths [m]; 95 % lie above, and below, one edge."""
        size = np.log(1e3 * width)
        level, (first, mixed, second) = self.intercept + self.slope * size, self.covariance
        margin = self.quantile * np.sqrt(first + 2 * mixed * size + second * size**2)
        return expit(level - margin), expit(level), expit(level + margin)


@dataclass(frozen=True)
class Detection:
    """Detection against width: the tested widths [m], observed shares, and the fit; None if detected and missed do not overlap."""

    smallest: float
    largest: float
    bins: tuple[WidthBin, ...]
    fit: DetectionFit | None


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


def detection(detected: np.ndarray, width: FloatArray, specimen: IntArray) -> Detection | None:
    """Detection of faulty records against their width [m], all of shape (record,); None if no width is known."""
    known = width > 0
    if not known.any():
        return None
    detected, width, specimen = detected[known].astype(float), width[known], specimen[known]
    number = ranges(width, BINS)
    bins = tuple(
        WidthBin(int(held.sum()), float(width[held].mean()), float(detected[held].mean()))
        for held in (number == k for k in np.unique(number))
    )
    return Detection(float(width.min()), float(width.max()), bins, fit_detection(detected, width, specimen))


def fit_detection(detected: FloatArray, width: FloatArray, specimen: IntArray) -> DetectionFit | None:
    """Fit the probability of detection; None if the likelihood has no maximum, or there are fewer than three specimens."""
    hits, misses = width[detected == 1], width[detected == 0]
    specimens, number = np.unique(specimen, return_inverse=True)
    if min(len(hits), len(misses)) == 0 or len(specimens) < 3:
        return None
    if misses.max() <= hits.min() or hits.max() <= misses.min():
        return None
    size = np.stack([np.ones(len(width)), np.log(1e3 * width)], axis=1)
    fitted = LogisticRegression(C=np.inf, solver="newton-cholesky", tol=1e-8, fit_intercept=False).fit(size, detected)
    beta = fitted.coef_[0]
    probability = expit(size @ beta)
    information = (size.T * (probability * (1 - probability))) @ size
    residual = size * (detected - probability)[:, None]
    half = np.linalg.solve(information, [np.bincount(number, weights=column) for column in residual.T])
    covariance = len(specimens) / (len(specimens) - 1) * half @ half.T
    first, mixed, second = (float(covariance[at]) for at in ((0, 0), (0, 1), (1, 1)))
    quantile = float(student.ppf(CONFIDENCE, len(specimens) - 2))
    intercept, slope = (float(one) for one in beta)
    level = intercept - float(logit(DETECTED))
    # a90/95 is the larger root of (level + slope x)^2 = quantile^2 variance(x)
    square, linear, constant = (
        slope**2 - quantile**2 * second,
        level * slope - quantile**2 * mixed,
        level**2 - quantile**2 * first,
    )
    sure = slope > 0 and square > 0
    sizes = (
        -level / slope if slope > 0 else math.inf,
        (-linear + math.sqrt(linear**2 - square * constant)) / square if sure else math.inf,
    )
    smallest, largest = size[:, 1].min(), size[:, 1].max()
    a90, a90_95 = (1e-3 * math.exp(one) if smallest <= one <= largest else None for one in sizes)
    return DetectionFit(intercept, slope, (first, mixed, second), quantile, a90, a90_95)


def roc(faulty: np.ndarray, score: FloatArray, specimen: IntArray, seed: int) -> Roc | None:
    """Receiver operating characteristic of records by a score of being faulty, all of shape (record,); None for one kind.

    The specimens of each kind are resampled apart.
    """
    if faulty.all() or not faulty.any():
        return None
    order = np.argsort(-score, kind="stable")
    last = np.flatnonzero(np.append(np.diff(score[order]) != 0, True))

    def curve(weight: FloatArray) -> tuple[float, FloatArray]:
        """Area, and shares at `FALSE_ALARMS`, of weighted records."""
        alarms, hits = (
            np.append(0, summed[last]) / summed[-1]
            for summed in (np.cumsum((weight * kind)[order]) for kind in (~faulty, faulty))
        )
        at = hits[np.searchsorted(alarms, FALSE_ALARMS, side="right") - 1]
        return float(np.trapezoid(hits, alarms)), at

    area, detected = curve(np.ones(len(score)))
    found = Roc(area, None, tuple(FALSE_ALARMS.tolist()), tuple(detected.tolist()))
    rng, weight = np.random.default_rng(seed), np.empty(len(score))
    kinds = [(kind, *np.unique(specimen[kind], return_inverse=True)) for kind in (faulty, ~faulty)]
    if min(len(units) for _, units, _ in kinds) < 2:
        return found
    areas, curves = np.empty(RESAMPLES), np.empty((RESAMPLES, len(FALSE_ALARMS)))
    for k in range(RESAMPLES):
        for kind, units, number in kinds:
            drawn = rng.integers(len(units), size=len(units))
            weight[kind] = np.bincount(drawn, minlength=len(units))[number]
        areas[k], curves[k] = curve(weight)
    low, high = np.quantile(curves, INTERVAL, axis=0).tolist()
    ends = np.quantile(areas, INTERVAL)
    return Roc(area, (float(ends[0]), float(ends[1])), found.false_alarms, found.detected, tuple(low), tuple(high))
