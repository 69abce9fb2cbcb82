"""Calibrated probabilities, and the least probability with which a model answers.

Estimators are over- or underconfident: of the records that an ensemble of forests gives a probability of 0.6, far more than 60 % may have
the class. A temperature [1]_ corrects this: the logarithms of the probabilities are divided by it, and the result is normalised. The order
of the classes of a record does not change.

``probabilities of records outside the training -> temperature -> combination of the windows of a recording -> thresholds``

.. [1] C. Guo, G. Pleiss, Y. Sun, K. Q. Weinberger, "On calibration of modern neural networks", ICML 2017.
"""

from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field
from scipy.optimize import minimize_scalar
from scipy.special import log_softmax, softmax

from features.baselines.records import FloatArray, IntArray

COVERAGE = 0.9  # share of records outside the training that a model answers
SMALLEST = 1e-6  # probabilities below it count as this: a forest can give 0
TEMPERATURES = (0.2, 5.0)  # lowest and highest: records that are all right would make any probability certain

Groups = Literal["rig", "specimen", "record", "nothing"]
Temperature = Annotated[float, Field(ge=TEMPERATURES[0], le=TEMPERATURES[1])]
Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]


class Calibration(BaseModel):
    """Numbers that turn the probabilities of an estimator into calibrated ones and into answers.

    Attributes
    ----------
    by
        Groups that its cross-validation kept together: rigs or specimens, single records if it kept none together, or ``nothing`` if it
        was not calibrated.
    temperature
        Divides the logarithms of the probabilities.
    dependence
        Correlation of the errors of two records of one recording, as in ``combine``: 0 if they are independent, 1 if they are the same.
    threshold, recording_threshold
        A record is answered if its largest probability is at least ``threshold``, and a recording of several records if its largest is
        at least ``recording_threshold``.
    coverage
        Share of the records outside the training that are answered.
    """

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    by: Groups
    temperature: Temperature
    dependence: Share
    threshold: Share
    recording_threshold: Share
    coverage: Share


UNCALIBRATED = Calibration(
    by="nothing", temperature=1.0, dependence=1.0, threshold=0.0, recording_threshold=0.0, coverage=1.0
)


def calibrate(probabilities: FloatArray, temperature: float) -> FloatArray:
    """Probabilities with a temperature, shape (record, class) to the same.

    >>> calibrate(np.array([[0.2, 0.8]]), 2.0).round(3).tolist()
    [[0.333, 0.667]]
    """
    return softmax(_logarithms(probabilities) / temperature, axis=1)


def combine(probabilities: FloatArray, recording: IntArray, dependence: float) -> FloatArray:
    """Probabilities of each recording from those of its records.

    The logarithms of the ``n`` records of a recording are averaged, multiplied by the number of independent records that they are worth,
    ``n / (1 + (n - 1) * dependence)``, and normalised. With a dependence of 1, the result is the geometric mean; with 0, the product.

    Parameters
    ----------
    probabilities
        Shape (record, class).
    recording
        Numbers from 0, without a gap, shape (record,).
    dependence
        Correlation of the errors of two records of one recording.

    Returns
    -------
    Shape (recording, class).
    """
    if np.array_equal(recording, np.arange(len(probabilities))):
        return probabilities
    total, count = _sum_logarithms(probabilities, recording)
    return softmax(total / (1 + (count - 1) * dependence)[:, None], axis=1)


def fit_calibration(
    probabilities: FloatArray, truth: IntArray, recording: IntArray, by: Groups = "record"
) -> Calibration:
    """Calibration from the probabilities of records outside the training.

    Temperature and dependence minimise the log-loss of records and recordings, with the same total weight for each class, as in training.
    The thresholds are those at which a share of ``COVERAGE`` is answered.

    Parameters
    ----------
    probabilities
        Shape (record, class).
    truth
        Column of the true class, shape (record,).
    recording
        As for ``combine``.
    by
        Groups that the cross-validation kept together.
    """
    logarithms = _logarithms(probabilities)
    temperature = float(
        np.exp(_lowest(lambda log: _loss(logarithms / np.exp(log), truth), *np.log(TEMPERATURES).tolist()))
    )
    records = calibrate(probabilities, temperature)
    dependence = _fit_dependence(records, truth, recording)
    threshold, recording_threshold = (answering(rows) for rows in (records, combine(records, recording, dependence)))
    return Calibration(
        by=by,
        temperature=temperature,
        dependence=dependence,
        threshold=threshold,
        recording_threshold=recording_threshold,
        coverage=float(np.mean(records.max(axis=1) >= threshold)),
    )


def _fit_dependence(probabilities: FloatArray, truth: IntArray, recording: IntArray) -> float:
    """Dependence with the lowest log-loss of recordings; 1, the most cautious, if no recording has several records."""
    total, count = _sum_logarithms(probabilities, recording)
    if count.max() < 2:
        return 1.0
    _, first = np.unique(recording, return_index=True)
    return _lowest(lambda dependence: _loss(total / (1 + (count - 1) * dependence)[:, None], truth[first]), 0.0, 1.0)


def _sum_logarithms(probabilities: FloatArray, recording: IntArray) -> tuple[FloatArray, FloatArray]:
    """Sum of the logarithms of the records of each recording, shape (recording, class), and their number."""
    count = np.bincount(recording).astype(float)
    total = np.zeros((len(count), probabilities.shape[1]))
    np.add.at(total, recording, np.log(np.maximum(probabilities, np.finfo(float).tiny)))
    return total, count


def _loss(logarithms: FloatArray, truth: IntArray) -> float:
    """Log-loss of the softmax of some rows, with the same total weight for each class."""
    of_truth = log_softmax(logarithms, axis=1)[np.arange(len(truth)), truth]
    return -float(np.average(of_truth, weights=1 / np.bincount(truth)[truth]))


def _lowest(function: Callable[[float], float], low: float, high: float) -> float:
    """Place of the lowest value of a function between two bounds."""
    return float(minimize_scalar(function, bounds=(low, high), method="bounded").x)


def answering(probabilities: FloatArray, coverage: float = COVERAGE) -> float:
    """Highest threshold at which at least a share ``coverage`` of the records is answered.

    >>> answering(np.array([[0.5, 0.5], [0.9, 0.1], [0.2, 0.8]]), 0.6)
    0.8
    """
    largest = np.sort(probabilities.max(axis=1))
    return float(largest[len(largest) - int(np.ceil(coverage * len(largest)))])


def _logarithms(probabilities: FloatArray) -> FloatArray:
    return np.log(np.maximum(probabilities, SMALLEST))
