"""Calibrated probabilities, and the smallest probability at which a model still answers.

Estimators are over- or underconfident: of the records that an ensemble of forests gives a probability of 0.6, far more than 60 % may have
the class. A temperature [1]_ corrects this: the logarithms of the probabilities are divided by it, and the result is normalised. The order
of the classes of a record does not change.

``probabilities of records outside the training -> temperature -> combination of the windows of a recording -> thresholds``

.. [1] C. Guo, G. Pleiss, Y. Sun, K. Q. Weinberger, "On calibration of modern neural networks", ICML 2017.
"""

from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field
from scipy.optimize import minimize_scalar
from scipy.special import log_softmax, softmax

from features.baselines.records import FloatArray, IntArray

COVERAGE = 0.9  # share of records outside the training that a model answers
SMALLEST = 1e-6  # probabilities below it count as this: a forest can give 0
TEMPERATURES = (0.05, 20.0)

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]


class Calibration(BaseModel):
    """Numbers that turn the probabilities of an estimator into calibrated ones and into answers.

    Attributes
    ----------
    by
        Groups that its cross-validation kept together: rigs, specimens, or ``nothing`` if it was not calibrated.
    temperature
        Divides the logarithms of the probabilities.
    threshold, recording_threshold
        Smallest of the largest probability at which a record, and a recording of several records, is answered.
    coverage
        Share of the records outside the training that are answered.
    """

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    by: Literal["rig", "specimen", "nothing"]
    temperature: Positive
    threshold: Share
    recording_threshold: Share
    coverage: Share


UNCALIBRATED = Calibration(by="nothing", temperature=1.0, threshold=0.0, recording_threshold=0.0, coverage=1.0)


def calibrated(probabilities: FloatArray, temperature: float) -> FloatArray:
    """Probabilities with a temperature, shape (record, class) to the same.

    >>> calibrated(np.array([[0.2, 0.8]]), 2.0).round(3).tolist()
    [[0.333, 0.667]]
    """
    return softmax(_logarithms(probabilities) / temperature, axis=1)


def combined(probabilities: FloatArray, recording: IntArray) -> FloatArray:
    """Probabilities of each recording: the normalised geometric mean of those of its records.

    The records of a recording share their machine and sensor, so that their errors are alike: the mean of the logarithms counts them as
    one record, and their sum would count them as independent.

    Parameters
    ----------
    probabilities
        Shape (record, class).
    recording
        Numbers from 0, without a gap, shape (record,).

    Returns
    -------
    Shape (recording, class).
    """
    total = np.zeros((int(recording.max()) + 1, probabilities.shape[1]))
    np.add.at(total, recording, np.log(np.maximum(probabilities, np.finfo(float).tiny)))
    return softmax(total / np.bincount(recording)[:, None], axis=1)


def fit_calibration(
    probabilities: FloatArray, truth: IntArray, recording: IntArray, by: Literal["rig", "specimen"]
) -> Calibration:
    """Calibration from the probabilities of records outside the training.

    The temperature minimises the log-loss, with the same total weight for each class, as in training. The thresholds are those at which
    a share of ``COVERAGE`` is answered.

    Parameters
    ----------
    probabilities
        Shape (record, class).
    truth
        Column of the true class, shape (record,).
    recording
        As for ``combined``.
    by
        Groups that the cross-validation kept together.
    """
    logarithms, weights = _logarithms(probabilities), 1 / np.bincount(truth)[truth]

    def loss(log_temperature: float) -> float:
        found = log_softmax(logarithms / np.exp(log_temperature), axis=1)
        return -float(np.average(found[np.arange(len(truth)), truth], weights=weights))

    low, high = np.log(TEMPERATURES).tolist()
    best = minimize_scalar(loss, bounds=(low, high), method="bounded")
    temperature = float(np.exp(best.x))
    records = calibrated(probabilities, temperature)
    threshold, recording_threshold = (answering(found) for found in (records, combined(records, recording)))
    return Calibration(
        by=by,
        temperature=temperature,
        threshold=threshold,
        recording_threshold=recording_threshold,
        coverage=float(np.mean(records.max(axis=1) >= threshold)),
    )


def answering(probabilities: FloatArray, coverage: float = COVERAGE) -> float:
    """Highest threshold at which at least a share ``coverage`` of the records is answered.

    >>> answering(np.array([[0.5, 0.5], [0.9, 0.1], [0.2, 0.8]]), 0.6)
    0.8
    """
    largest = np.sort(probabilities.max(axis=1))
    return float(largest[len(largest) - int(np.ceil(coverage * len(largest)))])


def _logarithms(probabilities: FloatArray) -> FloatArray:
    return np.log(np.maximum(probabilities, SMALLEST))
