"""Share of records in which a fault is seen, over its size: a curve, and the sizes that are seen in half and in nine of ten records.

The log-odds of the share rise linearly with the logarithm of the size, as handbooks of non-destructive testing have it [1]_. Records of one
machine are alike, so intervals come from a bootstrap over units, such as rigs, in which the threshold of the criterion is set again.

.. [1] MIL-HDBK-1823A, *Nondestructive evaluation system reliability assessment*, U.S. Department of Defense, 2009, appendix G.
"""

import numpy as np
from sklearn.linear_model import LogisticRegression
from threadpoolctl import threadpool_limits

from features.baselines.detection import INTERVAL, RESAMPLES
from features.baselines.records import FloatArray, IntArray

SHARES = np.array([0.5, 0.9])
FALSE_ALARMS = 0.01
PENALTY = 100.0  # inverse, so weak: it keeps the slope finite where all records from some size on are seen
FLATTEST = 0.1  # slope: 3 % more odds for a third more size
SLIGHT = 1e-9  # of a record


def fit_curve(size: FloatArray, seen: np.ndarray, weight: FloatArray) -> FloatArray:
    """Middle and slope of the share seen, ``1 / (1 + (middle / size) ** slope)``, which does not fall; all of shape (record,)."""
    # around the mean, where the odds do not depend on the slope
    mean = np.log(size).mean()
    # with a trace of both outcomes, since a fit needs both
    inputs = np.append(np.log(size) - mean, [0, 0])[:, None]
    fit = LogisticRegression(C=PENALTY).fit(inputs, np.append(seen, [0, 1]), np.append(weight, [SLIGHT, SLIGHT]))
    slope = max(fit.coef_[0, 0], FLATTEST)
    return np.array([np.exp(mean - fit.intercept_[0] / slope), slope])


def sizes_seen(
    size: FloatArray, score: FloatArray, unit: IntArray, healthy: np.ndarray, seed: int
) -> tuple[np.ndarray, FloatArray, FloatArray]:
    """Share of the faults that a criterion sees over their size.

    Parameters
    ----------
    size
        Of the faults of one class, 0 in all other records, shape (record,).
    score
        The higher, the more surely faulty, shape (record,).
    unit
        Rig or specimen that the bootstrap draws as a whole, shape (record,).
    healthy
        Whether a record is healthy, shape (record,). A fault is seen if its score is above that of all but `FALSE_ALARMS` of these.
    seed
        Of the bootstrap.

    Returns
    -------
    seen
        Shape (record,).
    curve
        Middle and slope of `fit_curve`.
    sizes
        From which `SHARES` are seen, and both ends of their 95 % intervals, shape (share, 3); 0 if the share is seen at the smallest
        size already, and infinity if it is not at the largest.
    """
    faulty, rng = size > 0, np.random.default_rng(seed)

    def seen(weight: FloatArray) -> np.ndarray:
        return score > np.quantile(score[healthy], 1 - FALSE_ALARMS, method="inverted_cdf", weights=weight[healthy])

    def curve(weight: FloatArray) -> FloatArray:
        return fit_curve(size[faulty], seen(weight)[faulty], weight[faulty])

    def resampled() -> FloatArray:
        weight = np.zeros(len(size))
        for kind in (faulty, healthy):
            units, number = np.unique(unit[kind], return_inverse=True)
            weight[kind] = np.bincount(rng.integers(len(units), size=len(units)), minlength=len(units))[number]
        return weight

    once = np.ones(len(size))
    # fits of some hundred records gain nothing from threads, and wait for them on a busy machine
    with threadpool_limits(1):
        curves = np.array([curve(once), *(curve(resampled()) for _ in range(RESAMPLES))])
    middle, slope = curves.T[..., None]
    sizes = middle * (SHARES / (1 - SHARES)) ** (1 / slope)
    ends = np.stack([sizes[0], *np.quantile(sizes[1:], INTERVAL, axis=0)], axis=-1)
    # beyond the sizes of the records nothing is known
    ends[ends < size[faulty].min()], ends[ends > size.max()] = 0, np.inf
    return seen(once), curves[0], ends
