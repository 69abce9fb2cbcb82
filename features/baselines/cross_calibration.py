"""Calibration of an estimator on records of rigs, or specimens, outside its training."""

from typing import Literal

import numpy as np

from features.baselines.calibration import UNCALIBRATED, Calibration, fit_calibration
from features.baselines.estimators import UNTRAINED, class_probabilities, make_estimator
from features.baselines.records import IntArray, Records
from features.baselines.splits import grouped_splits

FOLDS = 3  # each costs a training on two thirds of the records


def cross_calibration(records: Records, estimator: str, seed: int) -> Calibration:
    """Calibration from the predictions of a cross-validation by rig, or by specimen if there are too few rigs.

    An untrained baseline, and one whose classes are on too few specimens, stays uncalibrated.
    """
    by = None if estimator in UNTRAINED else calibration_groups(records)
    if by is None:
        return UNCALIBRATED
    classes, truth = np.unique(records.fault, return_inverse=True)
    probabilities = np.zeros((len(truth), len(classes)))
    for train, test in grouped_splits(records.fault, getattr(records, by), FOLDS, seed):
        fitted = make_estimator(estimator, seed).fit(records.features.iloc[train], records.fault[train])
        columns = np.searchsorted(classes, fitted.classes_)
        probabilities[np.ix_(test, columns)] = class_probabilities(fitted, records.features.iloc[test])
    return fit_calibration(probabilities, truth, records.recording, by)


def calibration_groups(records: Records) -> Literal["rig", "specimen"] | None:
    """The groups that a cross-validation can keep together, rigs if possible; None without any.

    Each class must be on at least as many groups as there are folds.
    """
    return next((by for by in ("rig", "specimen") if _suffices(records.fault, getattr(records, by))), None)


def _suffices(fault: IntArray, group: IntArray) -> bool:
    return all(len(np.unique(group[fault == code])) >= FOLDS for code in np.unique(fault))
