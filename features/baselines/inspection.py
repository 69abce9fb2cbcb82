"""Permutation importance and learning curves of scikit-learn, on splits that keep a specimen together.

scikit-learn indexes and copies the rows that it is given. It is given numbers of records, from which `NumberedRecords` looks the rows up:
so waveforms stay unread, and several features can be exchanged as one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import pandas as pd
import xarray as xr
from sklearn import inspection, model_selection
from sklearn.base import BaseEstimator, ClassifierMixin
from threadpoolctl import threadpool_limits

from features.baselines.estimators import class_probabilities, make_estimator
from features.baselines.own import Maker
from features.baselines.records import DEFAULT_GROUPS, FloatArray, IntArray, Records, records_of
from features.baselines.scores import mean_recall
from features.baselines.splits import grouped_case
from features.baselines.tracks import Split
from features.table.waveforms import Waveforms

LEAST_OF_A_CLASS = 2  # training specimens of a class in the smallest set, on average


@dataclass(frozen=True)
class CurvePoint:
    """Balanced accuracy with a number of training ``specimens`` and ``records``: of each fold, and its mean."""

    specimens: int
    records: int
    folds: tuple[float, ...]
    balanced_accuracy: float


class NumberedRecords(ClassifierMixin, BaseEstimator):
    """A classifier of records by their numbers, shape (record, part): of each part of the columns, the record that has its values."""

    def __init__(self, features: Any, estimator: str | Maker, seed: int, parts: Sequence[Sequence[int]] = ()) -> None:
        self.features, self.estimator, self.seed, self.parts = features, estimator, seed, parts

    def __sklearn_clone__(self) -> Self:
        """An unfitted one of the same records, which are not copied."""
        return type(self)(self.features, self.estimator, self.seed, self.parts)

    def fit(self, X: IntArray, y: IntArray) -> Self:
        """Fit the classifier to the records of the first column."""
        with threadpool_limits(1 if isinstance(self.estimator, str) else None, "blas"):
            self.fitted_ = make_estimator(self.estimator, self.seed).fit(self.features.take(X[:, 0]), y)
        self.classes_ = self.fitted_.classes_
        return self

    def predict(self, X: IntArray) -> IntArray:
        """Likeliest class of each row, shape (record,)."""
        rows = self.features.take(X[:, 0])
        if self.parts:
            values, whole = rows.to_numpy(copy=True), self.features.to_numpy()
            for part, numbers in zip(self.parts, X.T, strict=True):
                values[:, part] = whole[np.ix_(numbers, part)]
            rows = pd.DataFrame(values, columns=rows.columns)
        return self.classes_[class_probabilities(self.fitted_, rows).argmax(axis=1)]


def permutation_losses(
    records: Records, parts: Sequence[Sequence[int]], estimator: str | Maker, splits: Sequence[Split], seed: int
) -> FloatArray:
    """Loss of balanced accuracy outside the training when the values of a part of the columns are permuted, shape (split, part).

    Features that tell the same have little importance each, because a classifier can do without any one of them.
    """
    numbers = np.repeat(np.arange(len(records.fault))[:, None], len(parts), axis=1)
    losses, seeds = [], np.random.default_rng(seed).integers(2**31, size=len(splits)).tolist()
    for of_split, (train, test) in zip(seeds, splits, strict=True):
        fitted = NumberedRecords(records.features, estimator, seed, parts).fit(numbers[train], records.fault[train])
        found = inspection.permutation_importance(
            fitted, numbers[test], records.fault[test], scoring=_balanced_accuracy, n_repeats=1, random_state=of_split
        )
        losses.append(found["importances_mean"])
    return np.array(losses)


def learning_curve(data: xr.Dataset | Waveforms, estimator: str | Maker, *, folds: int = 5) -> tuple[CurvePoint, ...]:
    """Scores against the number of training specimens, which doubles from point to point up to all of them.

    The tested specimens are new. The parameters and errors are those of `cross_validate`.
    """
    records = records_of(data, DEFAULT_GROUPS)
    return curve_points(records, estimator, grouped_case(records, "specimen", folds, seed=0)[1], seed=0)


def curve_points(
    records: Records, estimator: str | Maker, splits: Sequence[Split], seed: int
) -> tuple[CurvePoint, ...]:
    """Points of the learning curve on given splits."""
    # the first split sets the sizes; a smaller training set is the beginning of a larger one
    ordered = sorted(((_by_specimen(records, train, seed), test) for train, test in splits), key=lambda of: -len(of[0]))
    largest = ordered[0][0]
    specimens = len(np.unique(records.specimen[largest]))
    # sizes double from the fewest specimens that can hold every class
    smallest = min(LEAST_OF_A_CLASS * len(np.unique(records.fault)), specimens)
    count = 1 + max(1, round(np.log2(specimens / smallest)))
    sizes = np.unique(np.rint(np.geomspace(smallest / specimens, 1, count) * len(largest)).astype(int))
    _, _, scores = model_selection.learning_curve(
        NumberedRecords(records.features, estimator, seed),
        np.arange(len(records.fault))[:, None],
        records.fault,
        cv=ordered,
        train_sizes=sizes,
        scoring=_balanced_accuracy,
        error_score="raise",  # pyright: ignore[reportArgumentType]
    )[:3]
    return tuple(
        CurvePoint(len(np.unique(records.specimen[largest[:size]])), int(size), tuple(of.tolist()), float(of.mean()))
        for size, of in zip(sizes, scores, strict=True)
    )


def _by_specimen(records: Records, train: IntArray, seed: int) -> IntArray:
    """Training records in an order of specimens in which all first ones have the classes about as often as all.

    A specimen that was recorded healthy and faulty counts as faulty.
    """
    specimen = pd.Series(records.specimen[train])
    fault = pd.Series(records.fault[train]).groupby(specimen).max().sample(frac=1, random_state=seed)
    of_class = fault.groupby(fault)
    order = (of_class.cumcount() / of_class.transform("size")).sort_values(kind="stable").index
    return train[np.argsort(pd.Index(order).get_indexer(pd.Index(specimen)), kind="stable")]


def _balanced_accuracy(classifier: NumberedRecords, X: IntArray, y: IntArray) -> float:
    """Mean share of the records of each class that are told right."""
    return mean_recall(y, classifier.predict(X))
