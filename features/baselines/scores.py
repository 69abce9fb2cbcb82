"""Figures of merit of a classifier over the classes that the tested records hold.

Balanced accuracy is the mean recall, macro-F1 the mean F1, both over the classes *present*: a prediction of a
class that is absent counts as an error and not as a class with nothing to find. Intervals resample specimens,
because records of one specimen say nearly the same thing [1]_.

.. [1] B. Efron, R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman & Hall, 1993, chapter 8.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from features.baselines.records import FloatArray, IntArray, Records
from gen.corpus import FAULTS

DRAWS = 1000
INTERVAL = (0.025, 0.975)


@dataclass(frozen=True)
class Scores:
    """Scores of one classifier on one set of records.

    Attributes
    ----------
    balanced_accuracy, macro_f1, accuracy
        Over the classes present.
    classes
        The classes present, the rows of ``confusion``.
    model_classes
        The classes the model can name, the columns of ``confusion``.
    confusion
        Number of records of each class that were given each name.
    records
        Number of things scored: records, or recordings within ``by_recording``.
    interval
        95 % bootstrap interval of the balanced accuracy over specimens, drawn class by class. A class of a
        single specimen adds nothing to its width, which is then too small.
    folds
        Balanced accuracy of each fold of a cross-validation, empty outside one.
    by_recording
        The same after the probabilities of all records of a recording are averaged.
    seen
        How many of the records the model was trained on, 0 for a fair test.
    """

    balanced_accuracy: float
    macro_f1: float
    accuracy: float
    classes: tuple[str, ...]
    model_classes: tuple[str, ...]
    confusion: tuple[tuple[int, ...], ...]
    records: int
    interval: tuple[float, float]
    folds: tuple[float, ...] = ()
    by_recording: "Scores | None" = None
    seen: int = 0


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
        What was tested.
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
    """Count the records of each class of ``rows`` that were given each name of ``columns``.

    ``rows`` and ``columns`` are ascending; shape (row, column).
    """
    matrix = np.zeros((len(rows), len(columns)), dtype=np.intp)
    np.add.at(matrix, (np.searchsorted(rows, fault), np.searchsorted(columns, predicted)), 1)
    return matrix


def figures(matrix: IntArray, rows: IntArray, columns: IntArray) -> Figures:
    """Mean recall, mean F1 and accuracy over the classes of ``rows``; the F1 of a class never named is 0."""
    same = rows[:, None] == columns
    hits = (matrix * same).sum(axis=1)
    named = same @ matrix.sum(axis=0)
    there = matrix.sum(axis=1)
    return Figures(
        balanced_accuracy=float(np.mean(hits / there)),
        macro_f1=float(np.mean(2 * hits / (there + named))),
        accuracy=float(hits.sum() / there.sum()),
    )


def bootstrap_interval(fault: IntArray, correct: np.ndarray, specimen: IntArray, seed: int) -> tuple[float, float]:
    """95 % percentile interval of the balanced accuracy, resampling the specimens of each class."""
    rng = np.random.default_rng(seed)
    classes = np.unique(fault)
    recall = np.zeros(DRAWS)
    for c in classes:
        of_class = fault == c
        _, number = np.unique(specimen[of_class], return_inverse=True)
        records, hits = np.bincount(number), np.bincount(number, weights=correct[of_class])
        drawn = rng.integers(len(records), size=(DRAWS, len(records)))
        recall += hits[drawn].sum(axis=1) / records[drawn].sum(axis=1)
    low, high = np.quantile(recall / len(classes), INTERVAL)
    return float(low), float(high)
