"""The baselines, from the majority class to an ensemble, as one registry of scikit-learn estimators.

Missing features are replaced by the median of the training records. All classes have the same total weight.
Sizes are chosen for a few hundred to a few thousand records of about a hundred features.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from scipy.special import softmax
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.dummy import DummyClassifier
from sklearn.ensemble import (
    ExtraTreesClassifier,
    HistGradientBoostingClassifier,
    RandomForestClassifier,
    VotingClassifier,
)
from sklearn.impute import SimpleImputer
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC
from sklearn.utils.validation import check_is_fitted, validate_data

from features.baselines.own import Maker, OwnClassifier, of_margins
from features.baselines.records import FloatArray, IntArray
from features.table.class_features import COMBS, EVIDENCE, class_features
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY

if TYPE_CHECKING:
    from pandas import DataFrame

    from features.table.waveforms import Waveforms

Estimator = Any  # a scikit-learn classifier of indices into FAULTS; the stubs define no common type

TREES = 120  # of each forest; 200 score the same on real recordings, and 120 keep the file of an ensemble below 5 MB
LEAF = (
    1 / 300
)  # share of the training records in each leaf of the extra trees, so that a file does not grow with its corpus
ROUNDS = 40  # of boosting
RIVAL_SHARE = 0.5  # of the highest series: a second one below that may be sidebands or some harmonics of the first


class EnvelopeRule(ClassifierMixin, BaseEstimator):
    """Untrained diagnosis rule: predict the fault with the highest comb, or healthy if no comb exceeds a threshold.

    A comb is the mean logarithm of three harmonics of a fault line over the floor of the whitened envelope
    spectrum. In white noise, fewer than one record in a hundred has a comb above 1.0, which means three harmonics
    that are e times the floor in the geometric mean.

    The rule always distinguishes healthy and the classes with a comb. It predicts cage and compound only if the
    records that it is fitted to contain them: see `rule_levels`.

    Parameters
    ----------
    threshold
        Level that a comb must exceed to be a fault.
    """

    def __init__(self, threshold: float = 1.0) -> None:
        self.threshold = threshold

    def fit(self, X: "DataFrame", y: IntArray) -> Self:
        """Store the column names of a data frame and the classes; the rule has no parameters to learn.

        Raises
        ------
        ValueError
            If a feature of ``features.table.class_features.EVIDENCE`` is not among the columns.
        """
        missing = set(EVIDENCE) - set(getattr(X, "columns", ()))
        if missing:
            raise ValueError(f"envelope rule: no column {min(missing)!r}; give a data frame with the lines features.")
        self._check_columns(X, reset=True)
        self.classes_ = np.union1d([FAULTS.index(fault) for fault in (HEALTHY, *COMBS)], y)
        return self

    def predict_proba(self, X: "DataFrame") -> FloatArray:
        """Softmax of the levels of `rule_levels`, shape (record, class)."""
        check_is_fitted(self)
        self._check_columns(X, reset=False)
        levels = rule_levels(X, self.threshold)
        return softmax(np.stack([levels[FAULTS[c]] for c in self.classes_], axis=1), axis=1)

    def predict(self, X: "DataFrame") -> IntArray:
        """Index into ``gen.corpus.FAULTS``, shape (record,)."""
        return self.classes_[self.predict_proba(X).argmax(axis=1)]

    def _check_columns(self, X: Any, *, reset: bool) -> None:
        """Store the column names if ``reset``, else require the stored ones."""
        validate_data(self, X, skip_check_array=True, reset=reset)


def rule_levels(features: "DataFrame", threshold: float) -> dict[str, FloatArray]:
    """Level of each class, shape (record,); the rule predicts the class with the highest level.

    The level of a class is the mean of its features in `features.table.class_features`; a missing feature counts
    as -inf, and so does a class without features: the rule never predicts it. Three classes differ:

    - Healthy: the threshold.
    - Cage: the mean of the first two lines of FTF, or -inf if these lines come from a spalled ball, which passes the
      load zone once per cage revolution. They come from the cage if 2 BSF is less than half as high, or if BPFO, a
      multiple of FTF, lies between the two levels: an impact once per cage revolution has lines at all multiples of FTF.
    - Compound: the sum of the two highest combs less a bar, so that it exceeds the highest comb if the second comb
      exceeds the bar. The bar is the highest of the threshold, half the highest comb, and the cage level. The comb of
      2 BSF counts only up to the level of the FTF lines, because shaft sidebands of BPFI can coincide with it.
    """
    levels = {name: _mean(features, own) for name in FAULTS if (own := class_features(name))}
    outer, ball, series = (levels[name] for name in ("outer", "ball", "cage"))
    from_cage = (ball < RIVAL_SHARE * series) | ((ball < outer) & (outer < series))
    cage = np.where(from_cage, series, -np.inf)
    combs = {name: levels[name] for name in COMBS} | {"ball": np.minimum(ball, series)}
    second, first = np.sort(list(combs.values()), axis=0)[-2:]
    bar = np.maximum.reduce([np.full_like(cage, threshold), cage, RIVAL_SHARE * first])
    unknown = dict.fromkeys(FAULTS, np.full_like(cage, -np.inf))
    return unknown | levels | {HEALTHY: np.full_like(cage, threshold), "cage": cage, "compound": first + second - bar}


def _mean(features: "DataFrame", columns: Sequence[str]) -> FloatArray:
    """Mean of some features, missing values as -inf, shape (record,)."""
    return np.mean([np.nan_to_num(features[column].to_numpy(), nan=-np.inf) for column in columns], axis=0)


def majority(seed: int) -> DummyClassifier:
    """The most frequent class of the training, whatever the record."""
    return DummyClassifier(strategy="most_frequent", random_state=seed)


def envelope_rule(_seed: int) -> EnvelopeRule:
    """The untrained rule on combs of fault lines."""
    return EnvelopeRule()


def _filled(*steps: BaseEstimator) -> Pipeline:
    return make_pipeline(SimpleImputer(strategy="median", keep_empty_features=True), *steps)


def logistic_regression(seed: int, strength: float = 0.1) -> Pipeline:
    """Logistic regression; ``strength`` is the inverse of its penalty."""
    return _filled(
        StandardScaler(),
        LogisticRegression(C=strength, max_iter=5000, class_weight="balanced", random_state=seed),
    )


def svm(seed: int) -> Pipeline:
    """Support vector machine with a radial kernel."""
    return _filled(StandardScaler(), SVC(class_weight="balanced", break_ties=True, random_state=seed))


def random_forest(seed: int) -> Pipeline:
    """Random forest."""
    return _filled(RandomForestClassifier(TREES, class_weight="balanced", random_state=seed))


def extra_trees(seed: int) -> Pipeline:
    """Trees with random thresholds."""
    trees = ExtraTreesClassifier(
        TREES,
        min_samples_leaf=LEAF,  # pyright: ignore[reportArgumentType]
        class_weight="balanced",
        random_state=seed,
    )
    return _filled(trees)


def gradient_boosting(seed: int) -> Pipeline:
    """Gradient boosting on histograms."""
    boosting = HistGradientBoostingClassifier(
        max_iter=ROUNDS,
        max_leaf_nodes=8,
        min_samples_leaf=5,
        max_bins=32,  # weighted classes make each bin cost 0.1 ms per feature and fit
        learning_rate=0.2,
        early_stopping=False,  # pyright: ignore[reportArgumentType]
        class_weight="balanced",
        random_state=seed,
    )
    return _filled(boosting)


def ensemble(seed: int) -> VotingClassifier:
    """Three parts of extra trees and one of a strongly regularised logistic regression.

    Both average over many features instead of following a few. So models of two corpora drawn from one recipe agree better on real
    recordings than forests with leaves of one record do, at the same balanced accuracy. The logistic regression gives fewer false alarms
    and the trees tolerate wrong speed labels better.
    """
    members = [("extra_trees", extra_trees(seed)), ("logistic_regression", logistic_regression(seed, 0.003))]
    return VotingClassifier(members, voting="soft", weights=[3, 1])


def relative_ensemble(seed: int) -> VotingClassifier:
    """Ensemble for records relative to a reference; there are twice as many features, and the changes tell more than the others.

    So each node of a tree tries more of them, and the logistic regression is less regularised and has a larger part. On simulated rigs
    outside the training and on recordings, both the balanced accuracy and the log-loss are better than with the settings of the ensemble.
    """
    trees = ExtraTreesClassifier(
        TREES,
        min_samples_leaf=LEAF,  # pyright: ignore[reportArgumentType]
        max_features=0.3,  # pyright: ignore[reportArgumentType]
        class_weight="balanced",
        random_state=seed,
    )
    members = [("extra_trees", _filled(trees)), ("logistic_regression", logistic_regression(seed, 0.01))]
    return VotingClassifier(members, voting="soft", weights=[2, 1])


ESTIMATORS: dict[str, Callable[[int], Estimator]] = {
    maker.__name__: maker
    for maker in (
        majority,
        envelope_rule,
        logistic_regression,
        svm,
        random_forest,
        extra_trees,
        gradient_boosting,
        ensemble,
    )
}
RELATIVE_ESTIMATORS: dict[str, Callable[[int], Estimator]] = {"relative_ensemble": relative_ensemble}
"""Estimators for records relative to a reference alone; the other baselines take such records as they are."""
MAKERS = ESTIMATORS | RELATIVE_ESTIMATORS


def relative_name(name: str) -> str:
    """Name of the estimator that a baseline uses for records relative to a reference."""
    return f"relative_{name}" if f"relative_{name}" in RELATIVE_ESTIMATORS else name


def make_estimator(name: str | Maker, seed: int) -> Estimator:
    """Unfitted baseline, estimator for records relative to a reference, or classifier of the user.

    It is one of indices into ``gen.corpus.FAULTS``.

    Raises
    ------
    ValueError
        For a name that is not in the registry.
    EstimatorError
        For a classifier that cannot be made.
    """
    if not isinstance(name, str):
        return OwnClassifier(name, seed)
    check_baseline(name)
    return MAKERS[name](seed)


def check_baseline(name: str) -> None:
    """ValueError for a name that is not in the registry."""
    if name not in MAKERS:
        raise ValueError(f"estimator: {name!r} is no baseline; choose from {', '.join(ESTIMATORS)}.")


def class_probabilities(estimator: Estimator, features: "DataFrame | Waveforms") -> FloatArray:
    """Probability of each of ``estimator.classes_``, shape (record, class); the largest is the prediction.

    A support vector machine gives no probabilities; the softmax of its decision values is returned instead.
    """
    if hasattr(estimator, "predict_proba"):
        return np.asarray(estimator.predict_proba(features))
    return of_margins(np.asarray(estimator.decision_function(features)))
