"""Permutation importance of features, on splits that keep a specimen together."""

from collections.abc import Sequence

import numpy as np

from features.baselines.estimators import class_probabilities
from features.baselines.fitting import fits
from features.baselines.own import Maker
from features.baselines.records import FloatArray, Records
from features.baselines.scores import mean_recall
from features.baselines.tracks import Split


def permutation_losses(
    records: Records, parts: Sequence[Sequence[int]], estimator: str | Maker, splits: Sequence[Split], seed: int
) -> FloatArray:
    """Loss of balanced accuracy outside the training when the values of a part of the columns are permuted, shape (split, part).

    The columns of a part are permuted together, which scikit-learn does not do. Features that tell the same have little
    importance each, because a classifier can do without any one of them.
    """
    rng, losses = np.random.default_rng(seed), np.empty((len(splits), len(parts)))
    fitted = fits(records.features, records.fault, estimator, splits, seed)
    for of_split, (_, test), (classifier, probabilities) in zip(losses, splits, fitted, strict=True):
        rows, truth = records.features.take(test), records.fault[test]
        whole = mean_recall(truth, classifier.classes_[probabilities.argmax(axis=1)])
        for number, part in enumerate(parts):
            permuted = rows.copy()
            permuted.iloc[:, part] = rows.iloc[rng.permutation(len(test)), part].to_numpy()
            told = class_probabilities(classifier, permuted).argmax(axis=1)
            of_split[number] = whole - mean_recall(truth, classifier.classes_[told])
    return losses
