"""Cross-validation that keeps all records of a specimen, or of a rig, on one side of every split.

Records of one specimen share its geometry, transfer path and background. So a random split of records measures how
well a classifier recognises specimens, and its score can be 1.00 even if the labels are random.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import xarray as xr
from sklearn.model_selection import StratifiedGroupKFold

from features.baselines.calibration import UNCALIBRATED
from features.baselines.estimators import class_probabilities, make_estimator
from features.baselines.predictions import class_names, predictions
from features.baselines.records import (
    DEFAULT_GROUPS,
    FloatArray,
    IntArray,
    Records,
    check_classes,
    features_of,
    labelled_records,
)
from features.baselines.scores import Scores, confusion_matrix, figures, score
from features.baselines.severities import uncovered_in_splits
from gen.corpus import FAULTS
from gen.errors import CorpusError

Grouping = Literal["specimen", "rig"]
Split = tuple[IntArray, IntArray]


def cross_validate(
    table: xr.Dataset,
    estimator: str,
    *,
    by: Grouping = "specimen",
    folds: int = 5,
    groups: Sequence[str] = DEFAULT_GROUPS,
    seed: int = 0,
) -> Scores:
    """Scores of a baseline on specimens or rigs it was not trained on.

    Parameters
    ----------
    table
        A feature table.
    estimator
        A name of ``ESTIMATORS``.
    by
        Groups that a split must not divide.
    folds
        Number of splits. Their predictions are pooled; the balanced accuracy of each split is returned too.
    groups
        Groups of features.
    seed
        Of splits, estimator and bootstrap.

    Raises
    ------
    CorpusError
        If the table has only one class, or too few specimens or rigs for the folds.
    ValueError
        For an unknown estimator.
    """
    records = labelled_records(table, features_of(table, groups))
    check_groups(records, by, folds)
    splits = grouped_splits(records.fault, getattr(records, by), folds, seed)
    check_taught(records.fault, splits)
    scores = score_splits(records, records.fault, estimator, splits, seed)
    return replace(scores, uncovered_widths=uncovered_in_splits(records, splits))


def check_groups(records: Records, by: Grouping, folds: int) -> None:
    """Refuse records that cannot be cross-validated by group.

    Raises
    ------
    CorpusError
        If there are too few folds, groups or classes, or too few groups or records of a class.
    """
    group = getattr(records, by)
    present = check_classes(records)
    where = f"{records.title}, cross-validation"
    if folds < 2:
        message = f"{where}: {folds} folds are too few; use 2 or more."
        raise CorpusError(message)
    count = len(np.unique(group))
    if count < folds:
        advice = f"use at most {count} folds" if count > 1 else "test on another corpus instead"
        message = f"{where}: {count} {by}(s) cannot fill {folds} folds; {advice}."
        raise CorpusError(message)
    for c in present:
        fault, of_class = FAULTS[c], group[records.fault == c]
        if len(np.unique(of_class)) < 2:
            message = (
                f"{where}: all {fault} records are of one {by}, so that the fold that tests it has none to train on; "
                f"give a corpus with two or more, or test on another corpus instead."
            )
            raise CorpusError(message)
        if len(of_class) < folds:
            message = f"{where}: {len(of_class)} {fault} record(s) for {folds} folds; use fewer folds."
            raise CorpusError(message)


def grouped_splits(fault: IntArray, group: IntArray, folds: int, seed: int) -> list[Split]:
    """Training and test records of each fold, with classes balanced as evenly as the groups allow."""
    splitter = StratifiedGroupKFold(folds, shuffle=True, random_state=seed)
    splits: list[Any] = list(splitter.split(np.zeros((len(fault), 1)), fault, group))
    for train, test in splits:
        check_disjoint(group, train, test)
    return splits


def check_taught(fault: IntArray, splits: Sequence[Split]) -> None:
    """Refuse splits if one of them has a class without a training record.

    Raises
    ------
    CorpusError
        With the name of the first such class.
    """
    for train, _ in splits:
        untaught = np.setdiff1d(fault, fault[train])
        if len(untaught):
            name = FAULTS[untaught[0]]
            message = f"cross-validation: a fold has no {name} record to train on; use fewer folds."
            raise CorpusError(message)


def check_disjoint(group: IntArray, train: IntArray, test: IntArray) -> None:
    """Refuse a split that has a group on both sides.

    Raises
    ------
    CorpusError
        With the number of the first such group.
    """
    shared = np.intersect1d(group[train], group[test])
    if len(shared):
        message = f"split: group {shared[0]} is in training and in test; keep all its records on one side."
        raise CorpusError(message)


def score_splits(records: Records, labels: IntArray, estimator: str, splits: Sequence[Split], seed: int) -> Scores:
    """Scores against ``labels`` of the predictions of all splits, which together test each record once."""
    classes = np.unique(labels)
    probabilities = np.zeros((len(labels), len(FAULTS)))
    folds: list[float] = []
    for train, test in splits:
        known, unknown = records.features.iloc[train], records.features.iloc[test]
        fitted = make_estimator(estimator, seed).fit(known, labels[train])
        probabilities[np.ix_(test, fitted.classes_)] = class_probabilities(fitted, unknown)
        classes = np.union1d(classes, fitted.classes_)
        folds.append(_balanced_accuracy(labels[test], probabilities[test]))
    found = predictions(probabilities[:, classes], class_names(classes), records.recording, UNCALIBRATED)
    pooled = score(records._replace(fault=labels), found, seed)
    return replace(pooled, folds=tuple(folds))


def _balanced_accuracy(fault: IntArray, probabilities: FloatArray) -> float:
    present, every = np.unique(fault), np.arange(len(FAULTS))
    matrix = confusion_matrix(fault, probabilities.argmax(axis=1), present, every)
    return figures(matrix, present, every).balanced_accuracy
