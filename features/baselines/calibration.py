"""Calibrated probabilities, and the least probability with which a model answers.

Estimators are over- or underconfident: of the records that an ensemble of forests gives a probability of 0.6, far more than 60 % may have
the class. A temperature [1]_ corrects this: the logarithms of the probabilities are divided by it, and the result is normalised. The order
of the classes of a record does not change.

``probabilities of records outside the training -> temperature -> threshold``

.. [1] C. Guo, G. Pleiss, Y. Sun, K. Q. Weinberger, "On calibration of modern neural networks", ICML 2017.
"""

from typing import Literal, NamedTuple

import numpy as np
from scipy.special import log_softmax, softmax

from features.signal.rows import FloatArray, IntArray, group_means

COVERAGE = 0.9  # share of records outside the training that a model answers
SMALLEST = 1e-6  # probabilities below it count as this: a forest can give 0
TEMPERATURES = (0.2, 5.0)  # lowest and highest: records that are all right would make any probability certain

Groups = Literal["rig", "specimen", "record", "nothing"]


class Calibration(NamedTuple):
    """Numbers that turn the probabilities of an estimator into calibrated ones and into answers.

    Attributes
    ----------
    by
        Groups that its cross-validation kept together: rigs or specimens, single records if it kept none together, or ``nothing`` if it
        was not calibrated.
    temperature
        Divides the logarithms of the probabilities.
    threshold
        A record or recording is answered if its largest probability is at least this.
    coverage
        Share of the records outside the training that are answered.
    """

    by: Groups
    temperature: float
    threshold: float
    coverage: float


UNCALIBRATED = Calibration(by="nothing", temperature=1.0, threshold=0.0, coverage=1.0)


def calibrate(probabilities: FloatArray, temperature: float) -> FloatArray:
    """Probabilities with a temperature, shape (record, class) to the same.

    >>> calibrate(np.array([[0.2, 0.8]]), 2.0).round(3).tolist()
    [[0.333, 0.667]]
    """
    return softmax(_logarithms(probabilities) / temperature, axis=1)


def combine(probabilities: FloatArray, group: IntArray) -> FloatArray:
    """Geometric mean of the probabilities of the records of each group, shape (record, class) to (group, class).

    ``group`` holds numbers from 0 without a gap, shape (record,).
    """
    if np.array_equal(group, np.arange(len(probabilities))):
        return probabilities
    return softmax(group_means(np.log(np.maximum(probabilities, np.finfo(float).tiny)), group), axis=1)


def fit_calibration(probabilities: FloatArray, truth: IntArray, by: Groups = "record") -> Calibration:
    """Calibration from the probabilities of records outside the training.

    The temperature minimises the log-loss, with the same total weight for each class, as in training. The threshold is that at which a
    share of ``COVERAGE`` is answered.

    Parameters
    ----------
    probabilities
        Shape (record, class).
    truth
        Column of the true class, shape (record,).
    by
        Groups that the cross-validation kept together.
    """
    logarithms = _logarithms(probabilities)
    from scipy.optimize import minimize_scalar  # a tenth of a second, which a prediction need not wait for

    bounds = np.log(TEMPERATURES).tolist()
    lowest = minimize_scalar(lambda log: _loss(logarithms / np.exp(log), truth), bounds=bounds, method="bounded")
    temperature = float(np.exp(lowest.x))
    records = calibrate(probabilities, temperature)
    threshold = answering(records)
    coverage = float(np.mean(records.max(axis=1) >= threshold))
    return Calibration(by=by, temperature=temperature, threshold=threshold, coverage=coverage)


def _loss(logarithms: FloatArray, truth: IntArray) -> float:
    """Log-loss of the softmax of some rows, with the same total weight for each class."""
    of_truth = log_softmax(logarithms, axis=1)[np.arange(len(truth)), truth]
    return -float(np.average(of_truth, weights=1 / np.bincount(truth)[truth]))


def answering(probabilities: FloatArray, coverage: float = COVERAGE) -> float:
    """Highest threshold at which at least a share ``coverage`` of the records is answered.

    >>> answering(np.array([[0.5, 0.5], [0.9, 0.1], [0.2, 0.8]]), 0.6)
    0.8
    """
    largest = np.sort(probabilities.max(axis=1))
    return float(largest[len(largest) - int(np.ceil(coverage * len(largest)))])


def _logarithms(probabilities: FloatArray) -> FloatArray:
    return np.log(np.maximum(probabilities, SMALLEST))
