"""Figures of merit of a classifier over the classes of the tested records.

Balanced accuracy is the mean recall and macro-F1 the mean F1, both over the classes *present* in the test. The
prediction of an absent class counts as an error; the absent class itself is not averaged. Confidence intervals come
from a bootstrap [1]_ over specimens, because the records of one specimen are strongly correlated.

.. [1] B. Efron, R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman & Hall, 1993, chapter 8.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from features.baselines.records import FloatArray, IntArray, Records
from gen.corpus import FAULTS

RESAMPLES = 1000
INTERVAL = (0.025, 0.975)  # quantiles of a 95 % interval
Interval = tuple[float, float]


@dataclass(frozen=True)
class Scores:
    """Scores of one classifier on one set of records.

    Attributes
    ----------
    balanced_accuracy, macro_f1, accuracy
        Over the classes present in the test.
    classes
        The classes present, the rows of ``confusion``.
    model_classes
        The classes that the model can predict, the columns of ``confusion``.
    confusion
        Number of records by true and predicted class.
    records
        Number of records scored, or of recordings in ``by_recording``.
    interval
        95 % bootstrap interval of the balanced accuracy over specimens, resampled class by class. None if a class has
        only one specimen: the spread over its specimens is not known.
    folds
        Balanced accuracy of each fold of a cross-validation, else empty.
    by_recording
        Scores after averaging the probabilities of all records of a recording.
    seen
        Number of tested records that the model was trained on, 0 in a fair test.
    uncovered_widths
        Fault widths [m] by class that were tested and not trained, as in `features.baselines.severities`.
    """

    balanced_accuracy: float
    macro_f1: float
    accuracy: float
    classes: tuple[str, ...]
    model_classes: tuple[str, ...]
    confusion: tuple[tuple[int, ...], ...]
    records: int
    interval: Interval | None
    folds: tuple[float, ...] = ()
    by_recording: "Scores | None" = None
    seen: int = 0
    uncovered_widths: Mapping[str, tuple[float, ...]] = field(default_factory=dict)


class Figures(NamedTuple):
    """Three figures of one confusion matrix."""

    balanced_accuracy: float
    macro_f1: float
    accuracy: float


def score(records: Records, probabilities: FloatArray, model_classes: IntArray, seed: int = 0) -> Scores:
    """Scores by record and by recording.

    Parameters
    ----------
    records
        The tested records.
    probabilities
        Shape (record, class), a column for each of ``model_classes``.
    model_classes
        Indices into ``gen.corpus.FAULTS``, shape (class,).
    seed
        Of the bootstrap.
    """
    _, first, number = np.unique(records.recording, return_index=True, return_inverse=True)
    total = np.zeros((len(first), probabilities.shape[1]))
    np.add.at(total, number, probabilities)
    by_recording = _score(records.fault[first], records.specimen[first], total, model_classes, seed)
    by_record = _score(records.fault, records.specimen, probabilities, model_classes, seed)
    return replace(by_record, by_recording=by_recording)


def _score(
    fault: IntArray, specimen: IntArray, probabilities: FloatArray, model_classes: IntArray, seed: int
) -> Scores:
    predicted = model_classes[probabilities.argmax(axis=1)]
    present = np.unique(fault)
    matrix = confusion_matrix(fault, predicted, present, model_classes)
    return Scores(
        *figures(matrix, present, model_classes),
        classes=tuple(FAULTS[c] for c in present),
        model_classes=tuple(FAULTS[c] for c in model_classes),
        confusion=tuple(tuple(row) for row in matrix.tolist()),
        records=len(fault),
        interval=bootstrap_interval(fault, predicted == fault, specimen, seed),
    )


def confusion_matrix(fault: IntArray, predicted: IntArray, rows: IntArray, columns: IntArray) -> IntArray:
    """Number of records by true class, of ``rows``, and predicted class, of ``columns``, both ascending."""
    matrix = np.zeros((len(rows), len(columns)), dtype=np.intp)
    np.add.at(matrix, (np.searchsorted(rows, fault), np.searchsorted(columns, predicted)), 1)
    return matrix


def figures(matrix: IntArray, rows: IntArray, columns: IntArray) -> Figures:
    """Mean recall, mean F1 and accuracy over the classes of ``rows``; a class that is never predicted has F1 = 0."""
    same = rows[:, None] == columns
    hits = (matrix * same).sum(axis=1)
    predicted = same @ matrix.sum(axis=0)
    tested = matrix.sum(axis=1)
    return Figures(
        balanced_accuracy=float(np.mean(hits / tested)),
        macro_f1=float(np.mean(2 * hits / (tested + predicted))),
        accuracy=float(hits.sum() / tested.sum()),
    )


def bootstrap_interval(fault: IntArray, correct: np.ndarray, specimen: IntArray, seed: int) -> Interval | None:
    """95 % percentile interval of the balanced accuracy, resampling the specimens of each class.

    None if a class has only one specimen: every resample would repeat it, and the interval would be too narrow.
    """
    rng = np.random.default_rng(seed)
    classes = np.unique(fault)
    recall = np.zeros(RESAMPLES)
    for c in classes:
        of_class = fault == c
        _, number = np.unique(specimen[of_class], return_inverse=True)
        records, hits = np.bincount(number), np.bincount(number, weights=correct[of_class])
        if len(records) < 2:
            return None
        drawn = rng.integers(len(records), size=(RESAMPLES, len(records)))
        recall += hits[drawn].sum(axis=1) / records[drawn].sum(axis=1)
    low, high = np.quantile(recall / len(classes), INTERVAL)
    return float(low), float(high)


def interval_text(interval: Interval | None, decimals: int = 3) -> str:
    """Text of an interval, for people.

    >>> interval_text((0.8391, 0.9), 2), interval_text(None)
    ('0.84 to 0.90', 'not known')
    """
    return "not known" if interval is None else " to ".join(f"{end:.{decimals}f}" for end in interval)
