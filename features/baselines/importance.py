"""Permutation importance of features [1]_: the loss of balanced accuracy outside the training without their values.

The values of a feature, or of several at once, are exchanged among the tested records of each split. Features that tell
the same have little importance each, because a classifier can do without any one of them.

.. [1] L. Breiman, "Random forests", *Machine Learning* 45 (2001) 5-32.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from features.baselines.estimators import class_probabilities
from features.baselines.fitting import fits
from features.baselines.own import Maker
from features.baselines.records import FloatArray, IntArray, Records
from features.baselines.tracks import Split

PREDICTED_ROWS = 10_000  # together: of few rows, a call of the classifier takes most of the time


def permutation_importance(
    records: Records,
    parts: Sequence[Sequence[int]],
    estimator: str | Maker,
    splits: Sequence[Split],
    seed: int,
) -> FloatArray:
    """Mean loss of balanced accuracy over the splits for each part of the columns, shape (part,)."""
    rng = np.random.default_rng(seed)
    columns = records.features.columns
    losses = np.empty((len(splits), len(parts)))
    fitted = fits(records.features, records.fault, estimator, splits, seed)
    for fold, ((_, test), (fitted_one, of_tested)) in enumerate(zip(splits, fitted, strict=True)):
        rows, truth, classes = records.features.take(test).to_numpy(), records.fault[test], fitted_one.classes_
        whole = _balanced_accuracy(truth, classes[of_tested.argmax(axis=1)])
        together = max(1, PREDICTED_ROWS // len(rows))
        for first in range(0, len(parts), together):
            chosen = parts[first : first + together]
            changed = np.repeat(rows[None], len(chosen), axis=0)
            for table, part in zip(changed, chosen, strict=True):
                table[:, part] = rng.permutation(rows[:, part])
            exchanged = pd.DataFrame(changed.reshape(-1, len(columns)), columns=columns)
            told = classes[class_probabilities(fitted_one, exchanged).argmax(axis=1)]
            losses[fold, first : first + together] = whole - _balanced_accuracy(truth, told.reshape(len(chosen), -1))
    return losses.mean(axis=0)


def _balanced_accuracy(truth: IntArray, told: IntArray) -> FloatArray:
    """Mean share of the records of each class that are told right, from classes of shape (..., record)."""
    return np.mean([np.mean(told[..., truth == c] == c, axis=-1) for c in np.unique(truth)], axis=0)
