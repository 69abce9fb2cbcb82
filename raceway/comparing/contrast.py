"""Two samples of one feature side by side: the probability that one is higher, and quantiles."""

import numpy as np

from features.signal.rows import FloatArray


def auc(below: FloatArray, above: FloatArray, below_weights: FloatArray, above_weights: FloatArray) -> float:
    """Probability that a value of ``above`` is higher than one of ``below``; equal values count half.

    0.5: the two are alike in this respect. 1: every value of ``above`` is higher. 0: every value is lower.

    >>> one = np.ones(2)
    >>> auc(np.array([1.0, 2.0]), np.array([2.0, 3.0]), one, one)
    0.875

    Parameters
    ----------
    below, above
        Finite values, shapes (record,) each.
    below_weights, above_weights
        Their weights, shapes (record,), with positive sums.
    """
    order = np.argsort(below, kind="stable")
    values = below[order]
    shares = np.concatenate([[0.0], np.cumsum(below_weights[order])])
    lower = shares[np.searchsorted(values, above, side="left")]
    not_higher = shares[np.searchsorted(values, above, side="right")]
    return float((above_weights * (lower + not_higher)).sum() / (2 * shares[-1] * above_weights.sum()))


def quantiles(values: FloatArray, weights: FloatArray, shares: tuple[float, ...]) -> list[float]:
    """Smallest values that are not exceeded by at least these shares of the weight.

    >>> quantiles(np.array([3.0, 1.0, 2.0, 4.0]), np.ones(4), (0.5,))
    [2.0]
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order]) / weights.sum()
    places = np.searchsorted(reached, np.asarray(shares) - 1e-12)
    return [float(value) for value in values[order][np.minimum(places, len(values) - 1)]]
