"""Calibration of an estimator on records of rigs, or specimens, outside its training."""

from collections.abc import Callable
from typing import Literal

import numpy as np

from features.baselines.calibration import (
    UNCALIBRATED,
    Calibration,
    fit_calibration,
)
from features.baselines.estimators import Estimator
from features.baselines.fitting import fits
from features.baselines.names import UNTRAINED
from features.baselines.own import Maker
from features.baselines.records import Records
from features.baselines.tracks import Split, grouped_splits
from gen.support.executor import Workers

FOLDS = 3  # at most; each costs a training on two thirds of the records


def fit_and_calibrate(
    records: Records,
    estimator: str | Maker,
    seed: int,
    *,
    workers: Workers = 1,
    done: Callable[[int], None] = lambda _: None,
) -> tuple[Estimator, Calibration]:
    """Fit a classifier to all records, and calibrate it by a cross-validation by rig, or by specimen if there are too few rigs.

    An untrained baseline, and one whose classes are on too few specimens, stays uncalibrated. ``workers`` and ``done`` are those of
    `features.baselines.fitting.fits`.
    """
    cross_validation = None if estimator in UNTRAINED else calibration_splits(records, seed)
    by, splits = ("nothing", []) if cross_validation is None else cross_validation
    # the whole training and the folds are independent fits, so all go to the workers at once
    every = np.arange(len(records.fault))
    (whole, _), *folds = fits(
        records.features, records.fault, estimator, [(every, every[:0]), *splits], seed, workers=workers, done=done
    )
    if not folds:
        return whole, UNCALIBRATED
    # each record is calibrated by the fold that did not train it
    classes, truth = np.unique(records.fault, return_inverse=True)
    probabilities = np.zeros((len(truth), len(classes)))
    for (_, test), (_, of_tested) in zip(splits, folds, strict=True):
        probabilities[test] = of_tested
    return whole, fit_calibration(probabilities, truth, by)


def calibration_splits(records: Records, seed: int) -> tuple[Literal["rig", "specimen"], list[Split]] | None:
    """Splits that keep rigs together, or specimens if rigs do not suffice; None if these do not either.

    They suffice if each class is on two or more of them, and every split trains records of all classes.
    """
    fault = records.fault
    for by in ("rig", "specimen"):
        group = getattr(records, by)
        fewest = min(len(np.unique(group[fault == code])) for code in np.unique(fault))
        if fewest >= 2:
            splits = grouped_splits(fault, group, min(fewest, FOLDS), seed)
            if all(np.isin(fault, fault[train]).all() for train, _ in splits):
                return by, splits
    return None
