"""The baselines, from no learning at all to an ensemble, as one registry of scikit-learn estimators.

Missing features are filled with the median of the training records. Classes weigh alike, however many records
they have. Sizes are chosen for a few hundred to a few thousand records of about a hundred features.
"""

from collections.abc import Callable
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

from features.baselines.records import FloatArray, IntArray
from gen.corpus import FAULTS

if TYPE_CHECKING:
    from pandas import DataFrame

Estimator = Any  # a scikit-learn classifier of indices into FAULTS; its stubs agree on no common type

TREES = 200  # of each forest
ROUNDS = 40  # of boosting
COMBS = {"inner": "whitened_bpfi_comb", "outer": "whitened_bpfo_comb", "ball": "whitened_2bsf_comb"}
CAGE_LINES = ("whitened_ftf", "whitened_2ftf")
RIVAL_SHARE = 0.5  # of the highest series: below that a second one may be its sidebands or some of its harmonics


class EnvelopeRule(ClassifierMixin, BaseEstimator):
    """The rule of an analyst, untrained: the fault whose comb stands highest, or healthy if none stands out.

    A comb is the mean logarithm of three harmonics of a fault line over the floor of the whitened envelope
    spectrum. Of white noise, fewer than one record in a hundred has one above 1.0: three harmonics that are,
    on average, e times the floor.

    It names healthy, inner, outer and ball always, cage and compound only if the records it is fitted to hold
    them: see `rule_levels`.

    Parameters
    ----------
    threshold
        The level a comb must exceed to be a fault.
    """

    def __init__(self, threshold: float = 1.0) -> None:
        self.threshold = threshold

    def fit(self, X: "DataFrame", y: IntArray) -> Self:
        """Take note of the columns of a data frame and of the classes there are; there is nothing to learn.

        Raises
        ------
        ValueError
            If a line is not among the columns.
        """
        missing = {*COMBS.values(), *CAGE_LINES} - set(getattr(X, "columns", ()))
        if missing:
            message = f"envelope rule: no column {min(missing)!r}; give a data frame with the lines features."
            raise ValueError(message)
        self._columns(X, reset=True)
        self.classes_ = np.union1d([FAULTS.index(fault) for fault in ("healthy", *COMBS)], y)
        return self

    def predict_proba(self, X: "DataFrame") -> FloatArray:
        """Softmax of the levels of `rule_levels`, shape (record, class)."""
        check_is_fitted(self)
        self._columns(X, reset=False)
        levels = rule_levels(X, self.threshold)
        return softmax(np.stack([levels[FAULTS[c]] for c in self.classes_], axis=1), axis=1)

    def predict(self, X: "DataFrame") -> IntArray:
        """Index into ``gen.corpus.FAULTS``, shape (record,)."""
        return self.classes_[self.predict_proba(X).argmax(axis=1)]

    def _columns(self, X: Any, *, reset: bool) -> None:
        """Take note of the names of the columns, or compare them with those."""
        validate_data(self, X, skip_check_array=True, reset=reset)


def rule_levels(features: "DataFrame", threshold: float) -> dict[str, FloatArray]:
    """What speaks for each class, shape (record,); the highest is the answer, and a missing feature speaks for none.

    - A spall: its comb.
    - Healthy: the threshold.
    - Cage: the mean of the first two lines of FTF, unless they are those of a spalled ball, which passes through the
      load once a turn of the cage. They are not where 2 BSF has less than half of them, or where BPFO, a multiple of
      FTF, stands between the two: a knock once a turn of the cage has lines at all its multiples.
    - Compound: the sum of the two highest combs less a bar, so that it exceeds the first where the second exceeds the
      bar: the threshold, half of the first, or the lines of the cage, whichever is highest. The comb of 2 BSF counts
      here only as far as the lines of FTF: shaft sidebands of BPFI can fall on it.
    """
    inner, outer, ball = (_known(features, column) for column in COMBS.values())
    series = np.mean([_known(features, column) for column in CAGE_LINES], axis=0)
    knocked = (ball < RIVAL_SHARE * series) | ((ball < outer) & (outer < series))
    cage = np.where(knocked, series, -np.inf)
    _, second, first = np.sort([inner, outer, np.minimum(ball, series)], axis=0)
    bar = np.maximum.reduce([np.full_like(cage, threshold), cage, RIVAL_SHARE * first])
    return {
        "healthy": np.full_like(cage, threshold),
        "inner": inner,
        "outer": outer,
        "ball": ball,
        "cage": cage,
        "compound": first + second - bar,
    }


def _known(features: "DataFrame", column: str) -> FloatArray:
    """Values of a feature, the missing ones lowest, shape (record,)."""
    return np.nan_to_num(features[column].to_numpy(), nan=-np.inf)


def _majority(seed: int) -> DummyClassifier:
    return DummyClassifier(strategy="most_frequent", random_state=seed)


def _envelope_rule(seed: int) -> EnvelopeRule:  # noqa: ARG001
    return EnvelopeRule()


def _filled(*steps: BaseEstimator) -> Pipeline:
    return make_pipeline(SimpleImputer(strategy="median", keep_empty_features=True), *steps)


def _logistic_regression(seed: int) -> Pipeline:
    return _filled(
        StandardScaler(),
        LogisticRegression(C=0.1, max_iter=5000, class_weight="balanced", random_state=seed),
    )


def _svm(seed: int) -> Pipeline:
    return _filled(StandardScaler(), SVC(class_weight="balanced", break_ties=True, random_state=seed))


def _random_forest(seed: int) -> Pipeline:
    return _filled(RandomForestClassifier(TREES, class_weight="balanced", random_state=seed))


def _extra_trees(seed: int) -> Pipeline:
    return _filled(ExtraTreesClassifier(TREES, class_weight="balanced", random_state=seed))


def _gradient_boosting(seed: int) -> Pipeline:
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


def _ensemble(seed: int) -> VotingClassifier:
    members = [
        ("random_forest", _random_forest(seed)),
        ("extra_trees", _extra_trees(seed)),
        ("logistic_regression", _logistic_regression(seed)),
    ]
    return VotingClassifier(members, voting="soft")


ESTIMATORS: dict[str, Callable[[int], Estimator]] = {
    "majority": _majority,
    "envelope_rule": _envelope_rule,
    "logistic_regression": _logistic_regression,
    "svm": _svm,
    "random_forest": _random_forest,
    "extra_trees": _extra_trees,
    "gradient_boosting": _gradient_boosting,
    "ensemble": _ensemble,
}
UNTRAINED = ("majority", "envelope_rule")
DEFAULT_ESTIMATOR = "ensemble"


def make_estimator(name: str, seed: int) -> Estimator:
    """Unfitted baseline.

    Raises
    ------
    ValueError
        For a name that is not in the registry.
    """
    if name not in ESTIMATORS:
        message = f"estimator: {name!r} is no baseline; choose from {', '.join(ESTIMATORS)}."
        raise ValueError(message)
    return ESTIMATORS[name](seed)


def class_probabilities(estimator: Estimator, features: "DataFrame") -> FloatArray:
    """Probability of each of ``estimator.classes_``, shape (record, class); the largest is the prediction.

    For a support vector machine, which has none, the softmax of its decision values.
    """
    if hasattr(estimator, "predict_proba"):
        return np.asarray(estimator.predict_proba(features))
    decision = np.asarray(estimator.decision_function(features))
    if decision.ndim == 1:
        decision = np.stack([-decision, decision], axis=1)
    return softmax(decision, axis=1)
