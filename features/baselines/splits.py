"""Cross-validation on a track: no split has a specimen on both sides, and the tested records are new in a stated way.

Records of one specimen share its geometry, transfer path and background. So a random split of records measures how
well a classifier recognises specimens, and its score can be 1.00 even if the labels are random.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from features.baselines.calibration import UNCALIBRATED, fit_calibration
from features.baselines.fitting import fits
from features.baselines.names import UNTRAINED, Track
from features.baselines.own import Maker
from features.baselines.predictions import fault_names, predictions
from features.baselines.records import DEFAULT_GROUPS, FloatArray, IntArray, Records, records_of
from features.baselines.scores import Scores, mean_recall, score
from features.baselines.tracks import Split, check_taught, grouped_splits, track_splits
from features.table.waveforms import Waveforms
from gen.corpus import FAULTS

Case = tuple[IntArray, list[Split]]
"""Labels, shape (record,), and splits to score a classifier with."""


def cross_validate(
    data: xr.Dataset | Waveforms,
    estimator: str | Maker,
    *,
    track: Track = "specimen",
    folds: int = 5,
    seed: int = 0,
) -> Scores:
    """Scores of a classifier on specimens, rigs or other groups that it was not trained on.

    Parameters
    ----------
    data
        A feature table, or the waveforms of a corpus (`features.open_waveforms`).
    estimator
        A name of ``ESTIMATORS``, a classifier with ``fit`` and ``predict``, which is copied for each fold, or a class
        or function that makes one. See `features.baselines.own`.
    track
        A name of `TRACKS`: the respect in which the tested records are new.
    folds
        Number of splits. Their predictions are pooled; the balanced accuracy of each split is returned too.
    seed
        Of splits, estimator and bootstrap.

    Raises
    ------
    CorpusError
        If the table has only one class, or too few specimens or other groups for the folds.
    EstimatorError
        If the classifier fails.
    ValueError
        For an unknown estimator or track.
    """
    records = records_of(data, DEFAULT_GROUPS)
    return score_splits(records, *grouped_case(records, track, folds, seed), estimator, seed)[0]


def controls(
    data: xr.Dataset | Waveforms,
    estimator: str | Maker,
    *,
    track: Track = "specimen",
    folds: int = 5,
    seed: int = 0,
) -> dict[str, Scores]:
    """Scores of both controls of a classifier: ``leaky`` and ``null``, as in `control_cases`.

    The parameters are those of `cross_validate`.
    """
    records = records_of(data, DEFAULT_GROUPS)
    cases = control_cases(records, track, folds, seed)
    return {name: score_splits(records, *case, estimator, seed)[0] for name, case in cases.items()}


def grouped_case(records: Records, track: Track, folds: int, seed: int) -> Case:
    """Classes, and the splits of a track.

    Raises
    ------
    CorpusError
        If the records cannot be split so.
    """
    splits = track_splits(records, records.fault, track, folds, seed)
    check_taught(records.fault, splits)
    return records.fault, splits


def control_cases(records: Records, track: Track, folds: int, seed: int) -> dict[str, Case]:
    """Labels and splits of the two controls of a track.

    ``leaky`` splits random records. ``null`` splits as the track does and permutes the labels among specimens: it must
    be near chance, because all else that could tell the label of a specimen is on one side of each split.
    """
    leaky = grouped_splits(records.fault, np.arange(len(records.fault)), folds, seed)
    check_taught(records.fault, leaky)
    permuted = permuted_labels(records, seed)
    return {"leaky": (records.fault, leaky), "null": (permuted, track_splits(records, permuted, track, folds, seed))}


def permuted_labels(records: Records, seed: int) -> IntArray:
    """Labels permuted among specimens, so that all records of a specimen still share one label, shape (record,).

    A specimen that was recorded healthy and faulty counts as two.
    """
    rng = np.random.default_rng(seed)
    units, number = np.unique(np.stack([records.specimen, records.fault]), axis=1, return_inverse=True)
    return rng.permutation(units[1])[number.reshape(-1)]


def score_splits(
    records: Records, labels: IntArray, splits: Sequence[Split], estimator: str | Maker, seed: int
) -> tuple[Scores, FloatArray | None]:
    """Scores against ``labels`` of the predictions of all splits, which together test a record at most once, as of `score`."""
    classes = np.unique(labels)
    probabilities = np.zeros((len(labels), len(FAULTS)))
    folds: list[float] = []
    fitted = fits(records.features, labels, estimator, splits, seed)
    for (_, test), (fold, of_tested) in zip(splits, fitted, strict=True):
        # a fold may lack a class, which then has the probability 0
        probabilities[np.ix_(test, fold.classes_)] = of_tested
        classes = np.union1d(classes, fold.classes_)
        folds.append(mean_recall(labels[test], probabilities[test].argmax(axis=1)))
    tested = np.sort(np.concatenate([test for _, test in splits]))
    # of all folds together: single folds may lack classes
    chosen = records._replace(fault=labels).at(tested)
    _, recording = np.unique(chosen.recording, return_inverse=True)
    # calibrated on these same predictions, so log-loss and calibration error are those of a model calibrated on the tested machines
    pooled = probabilities[np.ix_(tested, classes)]
    truth = np.searchsorted(classes, chosen.fault)
    calibration = UNCALIBRATED if estimator in UNTRAINED else fit_calibration(pooled, truth)
    together = predictions(pooled, fault_names(classes), recording, calibration)
    return score(chosen, together, seed, folds=tuple(folds))
