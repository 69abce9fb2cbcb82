"""Figures of merit of a classifier over the classes of the tested records.

Balanced accuracy is the mean recall and macro-F1 the mean F1, both over the classes *present* in the test. The
prediction of an absent class counts as an error; the absent class itself is not averaged. Confidence intervals come
from a bootstrap [1]_ over specimens, because the records of one specimen are strongly correlated.

.. [1] B. Efron, R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman & Hall, 1993, chapter 8.
.. [2] J. A. Hanley, A. Lippman-Hand, "If nothing goes wrong, is everything all right?", *JAMA* 249 (1983) 1743-1745.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from sklearn.metrics import confusion_matrix, f1_score, recall_score, roc_auc_score

from features.baselines.calibration import SMALLEST
from features.baselines.detection import INTERVAL, Roc, WidthBin, detection, roc
from features.baselines.predictions import Predictions
from features.baselines.records import HEALTHY_CODE, FloatArray, IntArray, Records
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY
from gen.support.display import Shown

BINS = 10  # of the reliability diagram
RESAMPLES = 1000
Interval = tuple[float, float]


@dataclass(frozen=True)
class Bin:
    """Records whose largest probability lies in one interval: their number, mean probability, and share of right ones."""

    records: int
    probability: float
    accuracy: float


@dataclass(frozen=True, repr=False)
class Scores(Shown):
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
        Scores after combining the probabilities of all records of a recording.
    false_alarms
        Share of the healthy records that are predicted to be faulty; None without a healthy record.
    log_loss
        Mean of minus the logarithm of the probability of the true class, with the same total weight for each class.
    auc
        Mean over the classes present of the area under the curve of this class against the rest; None with one class.
    ece
        Expected calibration error: mean difference between largest probability and accuracy over the ``reliability``
        bins, weighted by their records.
    reliability
        Records by their largest probability, in bins of equal width.
    detection, roc
        Detection of faults of any class by their width, and against false alarms, by record; empty, or None, where it is not known.
    coverage, answered_accuracy
        Share of the records that are answered, and the accuracy of these; None without any.
    faulty_among_healthy
        Share of the faulty recordings among those that are answered "healthy"; None if none is.
    reference
        What the records were compared with, in one sentence; empty without a reference.
    seen
        Number of tested records that the model was trained on, 0 in a fair test.
    specimens
        Number of tested specimens of the class with the fewest.
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
    false_alarms: float | None = None
    log_loss: float | None = None
    auc: float | None = None
    ece: float | None = None
    reliability: tuple[Bin, ...] = ()
    detection: tuple[WidthBin, ...] = ()
    roc: Roc | None = None
    coverage: float = 1.0
    answered_accuracy: float | None = None
    faulty_among_healthy: float | None = None
    reference: str = ""
    seen: int = 0
    specimens: int = 0

    def _heading(self) -> str:
        return f"Scores of {self.records:,} records: balanced accuracy {self.balanced_accuracy:.3f}"

    def _facts(self) -> Mapping[str, object]:
        of_confusion = {
            f"{true} told as": ", ".join(
                f"{name} {count}" for name, count in zip(self.model_classes, row, strict=True) if count
            )
            for true, row in zip(self.classes, self.confusion, strict=True)
        }
        named = {"macro-F1": self.macro_f1, "log-loss": self.log_loss, "area under the curve": self.auc}
        whole = self.by_recording
        return {
            "95 % interval": interval_text(self.interval),
            "by recording": "" if whole is None else f"{whole.balanced_accuracy:.3f} of {whole.records:,}",
            **{name: value if value is None else f"{value:.3f}" for name, value in named.items()},
            "false alarms": self.false_alarms if self.false_alarms is None else f"{self.false_alarms:.3f}",
            **of_confusion,
            "reference": self.reference,
            "in the training": self.seen or "",
        }


def score(records: Records, predictions: Predictions, seed: int = 0, **told: Any) -> tuple[Scores, FloatArray | None]:
    """Scores by record and by recording, and the balanced accuracies by record of `resampled_recall`.

    Parameters
    ----------
    records
        The tested records.
    predictions
        Their predictions, with the recordings of ``records``.
    seed
        Of the bootstrap.
    **told
        Fields of the scores that do not follow from the predictions: ``folds``, ``reference``, ``seen``.
    """
    # a recording has the label of its first record
    _, first = np.unique(predictions.recording, return_index=True)
    faulty, healthy_column = records.fault != HEALTHY_CODE, np.array(predictions.classes) == HEALTHY
    detected = np.array(predictions.predicted)[faulty] != HEALTHY
    told["detection"] = detection(detected, records.width[faulty], records.specimen[faulty])
    told["roc"] = roc(faulty, -predictions.probabilities[:, healthy_column].sum(axis=1), records.specimen, seed)
    if (whole := predictions.by_recording) is not None:
        healthy = np.array(whole.answers) == HEALTHY
        share = _share(records.fault[first][healthy] != HEALTHY_CODE)
        of_whole, _ = _score(records.fault[first], records.specimen[first], whole, seed, faulty_among_healthy=share)
        told |= {"faulty_among_healthy": share, "by_recording": of_whole}
    return _score(records.fault, records.specimen, predictions, seed, **told)


def _score(
    fault: IntArray, specimen: IntArray, predictions: Predictions, seed: int, **told: Any
) -> tuple[Scores, FloatArray | None]:
    probabilities, model_classes = predictions.probabilities, np.array([FAULTS.index(c) for c in predictions.classes])
    predicted = model_classes[probabilities.argmax(axis=1)]
    present, right, answered = np.unique(fault), predicted == fault, predictions.answered
    matrix = confusion_matrix(fault, predicted, labels=range(len(FAULTS)))[np.ix_(present, model_classes)]
    bins = reliability_bins(probabilities.max(axis=1), right)
    resampled = resampled_recall(fault, right, specimen, seed)
    scores = Scores(
        mean_recall(fault, predicted),
        float(f1_score(fault, predicted, labels=present, average="macro")),
        float(right.mean()),
        classes=tuple(FAULTS[c] for c in present),
        model_classes=predictions.classes,
        confusion=tuple(tuple(row) for row in matrix.tolist()),
        records=len(fault),
        interval=None if resampled is None else ends_of(resampled),
        false_alarms=_share(predicted[fault == HEALTHY_CODE] != HEALTHY_CODE),
        log_loss=balanced_log_loss(fault, probabilities, model_classes),
        auc=area(fault, probabilities, model_classes),
        ece=expected_calibration_error(bins),
        reliability=bins,
        coverage=float(answered.mean()),
        answered_accuracy=_share(right[answered]),
        specimens=min(len(np.unique(specimen[fault == c])) for c in present),
        **told,
    )
    return scores, resampled


def _share(true: np.ndarray) -> float | None:
    return float(true.mean()) if len(true) else None


def _mean(values: FloatArray) -> float:
    """Exactly rounded mean, which does not depend on the order of the values."""
    return math.fsum(values) / len(values)


def balanced_log_loss(fault: IntArray, probabilities: FloatArray, model_classes: IntArray) -> float:
    """Mean over the classes present of the mean of minus the logarithm of the probability of the true class.

    A class that the model cannot predict has the smallest probability that is counted, ``SMALLEST``.
    """
    of_truth = (probabilities * (model_classes == fault[:, None])).sum(axis=1)
    losses = -np.log(np.maximum(of_truth, SMALLEST))
    return float(np.mean([_mean(losses[fault == c]) for c in np.unique(fault)]))


def area(fault: IntArray, probabilities: FloatArray, model_classes: IntArray) -> float | None:
    """Mean over the classes present of the area under the curve of one class against the rest; None with one class."""
    present = np.unique(fault)
    if len(present) < 2:
        return None
    return float(
        np.mean([roc_auc_score(fault == c, probabilities[:, model_classes == c].sum(axis=1)) for c in present])
    )


def reliability_bins(largest: FloatArray, right: np.ndarray) -> tuple[Bin, ...]:
    """Bins of equal width over 0..1 that hold a record, by the largest probability of each, shape (record,)."""
    number = np.minimum((largest * BINS).astype(int), BINS - 1)
    return tuple(
        Bin(int(held.sum()), _mean(largest[held]), float(right[held].mean()))
        for held in (number == k for k in np.unique(number))
    )


def expected_calibration_error(bins: Sequence[Bin]) -> float:
    """Mean difference between probability and accuracy of some bins, weighted by their records."""
    records = sum(bin_.records for bin_ in bins)
    return sum(bin_.records * abs(bin_.probability - bin_.accuracy) for bin_ in bins) / records


def mean_recall(fault: IntArray, predicted: IntArray) -> float:
    """Mean recall of the classes present, the balanced accuracy; other classes may be predicted."""
    return float(recall_score(fault, predicted, labels=np.unique(fault), average="macro"))


def resampled_recall(fault: IntArray, correct: np.ndarray, specimen: IntArray, seed: int) -> FloatArray | None:
    """Balanced accuracy of resamples of the specimens of each class, shape (resample,); those of one seed are the same ones.

    None if a class has only one specimen: every resample would repeat it, and an interval would be too narrow.
    """
    rng = np.random.default_rng(seed)
    classes = np.unique(fault)
    recall = np.zeros(RESAMPLES)
    for c in classes:
        of_class = fault == c
        _, number = np.unique(specimen[of_class], return_inverse=True)
        records, hits = np.bincount(number), np.bincount(number, weights=correct[of_class])
        # of one specimen every draw is the same
        if len(records) < 2:
            return None
        # as many specimens of the class as there are, with all their records
        drawn = rng.integers(len(records), size=(RESAMPLES, len(records)))
        recall += hits[drawn].sum(axis=1) / records[drawn].sum(axis=1)
    return recall / len(classes)


def ends_of(resampled: FloatArray) -> Interval:
    """95 % percentile interval of a figure that was resampled."""
    low, high = np.quantile(resampled, INTERVAL)
    return float(low), float(high)


def interval_text(interval: Interval | None, decimals: int = 3) -> str:
    """Text of an interval, for people.

    >>> interval_text((0.8391, 0.9), 2), interval_text(None)
    ('0.84 to 0.90', 'not known: a class has one specimen')
    """
    if interval is None:
        return "not known: a class has one specimen"
    return " to ".join(f"{end:.{decimals}f}" for end in interval)


def no_width_text(scored: Iterable[Scores]) -> str:
    """Sentence on intervals from 1 to 1, which tell nothing of specimens that were not tested [2]_; empty without one."""
    fewest = min((scores.specimens for scores in scored if scores.interval == (1, 1)), default=0)
    if not fewest:
        return ""
    return (
        f"An interval from 1 to 1 says no more than that all tested specimens are right: with {fewest} of a class, its true share of "
        f"errors may be up to {percent_text(1 - 0.05 ** (1 / fewest))}."
    )


def behind_text(behind: tuple[float, float, float] | None) -> str:
    """Text of how far a classifier lies below the best, for people.

    >>> behind_text((0.02, -0.01, 0.05)), behind_text((0.0, 0.0, 0.0)), behind_text(None)
    ('0.020 (-0.010 to 0.050)', 'best', 'not known')
    """
    if behind is None:
        return "not known"
    difference, *interval = behind
    return f"{difference:.3f} ({interval_text((interval[0], interval[1]))})" if any(behind) else "best"


def percent_text(share: float) -> str:
    """Text of a share, for people: three digits, and no rounding to none or all.

    >>> percent_text(0.1979), percent_text(0.9), percent_text(0.0003), percent_text(0.9999), percent_text(0.0)
    ('19.8 %', '90 %', '< 0.1 %', '> 99.9 %', '0 %')
    """
    if 0 < share < 0.001:
        return "< 0.1 %"
    return "> 99.9 %" if 0.999 < share < 1 else f"{100 * share:.3g} %"
