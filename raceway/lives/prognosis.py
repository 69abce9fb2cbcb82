"""Estimates of remaining life, trained on some bearings and scored on others.

``age`` knows the median life alone, ``kaplan_meier`` and ``weibull`` the distribution of lives; ``boosting`` also has the features of a
snapshot, their change since the first snapshots of its bearing, and its age. It is trained on bearings that failed, each weighted by the
inverse of the probability that a bearing is not censored before [1]_. ``without_signal`` is the same from the age alone, its control.

Scores are those of the challenge of 2012 [2]_, the mean absolute error, the concordance, and the share of estimates within a fifth of the
truth [3]_. Before its spall begins nothing tells one bearing from another, so there the boosting may not be much better than its control.
Of sixty bearings of run_to_failure it is 3 % better, and 18 % with a feature that tells the life within 5 %: then something gives lives
away. Twelve bearings tell nothing, because censored ones outlive all that were trained on.

.. [1] J. M. Robins, D. M. Finkelstein, "Correcting for noncompliance and dependent censoring in an AIDS clinical trial with inverse
   probability of censoring weighted (IPCW) log-rank tests", Biometrics 56 (2000) 779-788.
.. [2] P. Nectoux et al., "PRONOSTIA: an experimental platform for bearings accelerated degradation tests", IEEE Int. Conf. Prognostics and
   Health Management, Denver, 2012.
.. [3] A. Saxena, J. Celaya, B. Saha, S. Saha, K. Goebel, "Metrics for offline evaluation of prognostic performance", Int. J. Prognostics
   and Health Management 1 (2010).
"""

from collections.abc import Callable, Iterable, Mapping
from numbers import Integral
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.model_selection import GroupKFold

from gen.corpus import specimen_numbers
from gen.support.errors import CorpusError
from raceway.lives.survival import BoolArray, FloatArray, kaplan_meier, weibull, weibull_median_left

FIRST = 5
"""Snapshots of a bearing that its later ones are compared with."""
SHARES = (0.5, 0.75, 0.9)
"""Of a life, where estimates are scored."""
WITHIN = 0.2
_DRAWS = 20
_NONE_FAILED = "no bearing of the feature table failed; make longer tests, or more bearings."
_NEEDED = ("age", "rul", "event", "identity", "rig", "specimen", "stage")


class Lives(NamedTuple):
    """Snapshots of some bearings, in rising age for each, shape (snapshot,) each."""

    features: FloatArray
    """Shape (snapshot, feature)."""
    age: FloatArray
    rul: FloatArray
    """NaN where not known."""
    failed: BoolArray
    bearing: NDArray[np.int_]
    damaged: BoolArray
    """Whether the spall has begun."""

    def some(self, where: Any) -> "Lives":
        """Some of the snapshots."""
        return self._replace(**{name: values[where] for name, values in self._asdict().items()})

    @property
    def ends(self) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Entry and end of each bearing, and whether it failed, as :func:`raceway.lives.survival.kaplan_meier` takes them."""
        _, first, count = np.unique(self.bearing, return_index=True, return_counts=True)
        last = first + count - 1
        failed = self.failed[last]
        return self.age[first], self.age[last] + np.where(failed, self.rul[last], 0.0), failed


Estimate = Callable[[Lives], FloatArray]


def check_lives(records: xr.Dataset, name: str) -> None:
    """Refuse records, or their table, that are not snapshots of lives, with a ``name`` for the sentence.

    Raises
    ------
    CorpusError
        If a variable of lives is missing.
    """
    if not isinstance(records, xr.Dataset) or not {*_NEEDED} <= {*records.variables}:
        raise CorpusError(f"{name}: has no lives; make one of a recipe with life, such as run_to_failure.")


def in_order(table: xr.Dataset, name: str) -> xr.Dataset:
    """Snapshots of lives by bearing and then by age; CorpusError with a ``name`` if they are none."""
    check_lives(table, name)
    return table.isel(record=np.lexsort((table["age"].values, specimen_numbers(table))))


def check_others(table: xr.Dataset, tested: xr.Dataset) -> None:
    """Refuse a table to test on that has bearings of the training, or other features; both are of lives.

    Raises
    ------
    CorpusError
        With a bearing that both have, or the advice to compute the same features.
    """
    ours, theirs = (
        {"/".join(str(text).split("/")[:3]) for text in of["identity"].values.tolist()} for of in (table, tested)
    )
    if common := sorted(ours & theirs):
        raise CorpusError(f"the tested bearings are among those of the training ({common[0]}); test other bearings.")
    if not np.array_equal(table["feature"].values, tested["feature"].values):
        raise CorpusError(
            "the tested bearings have other features than those of the training; compute the same groups of both."
        )


def bearing_folds(bearing: NDArray[Any], folds: int) -> Iterable[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Places of the training and of the test in each fold, none of which parts the snapshots of a bearing.

    Raises
    ------
    CorpusError
        If the number of folds is not a whole one from 2 to the number of bearings.
    """
    count = len(np.unique(bearing))
    if not isinstance(folds, Integral) or not 2 <= folds <= count:
        raise CorpusError(
            f"folds: {folds} is not a whole number from 2 to {count}, the number of bearings; use another, or more bearings."
        )
    return GroupKFold(int(folds), shuffle=True, random_state=0).split(bearing, groups=bearing)


def lives_of(table: xr.Dataset) -> Lives:
    """Lives of a feature table of a corpus of lives.

    Raises
    ------
    CorpusError
        If a variable of lives is missing, or no remaining life is known.
    """
    of = in_order(table, "the feature table")
    bearing = specimen_numbers(of)
    features = of["features"].transpose("record", "feature").values.astype(np.float64)
    failed, damaged = of["event"].values == 1, of["stage"].values > 0
    if not np.isfinite(of["rul"].values).any():
        raise CorpusError(_NONE_FAILED)
    return Lives(features, of["age"].values, of["rul"].values, failed, bearing, damaged)


def by_age(lives: Lives) -> Estimate:
    """Median life less the age."""
    median = float(kaplan_meier(*lives.ends).median_left(np.zeros(1))[0])
    return lambda tested: np.maximum(median - tested.age, 0.0)


def by_kaplan_meier(lives: Lives) -> Estimate:
    """Median of what bearings of this age had left."""
    survival = kaplan_meier(*lives.ends)
    return lambda tested: survival.median_left(tested.age)


def by_weibull(lives: Lives) -> Estimate:
    """The same by a Weibull distribution."""
    slope, scale = weibull(*lives.ends)
    return lambda tested: weibull_median_left(slope, scale, tested.age)


def by_boosting(lives: Lives, inputs: Callable[[Lives], FloatArray] | None = None) -> Estimate:
    """Gradient boosting of the logarithm of the remaining life, from some ``inputs``: by default features and age."""
    inputs = inputs or age_and_features
    entry, end, failed = lives.ends
    _, place = np.unique(lives.bearing, return_inverse=True)
    # a bearing that fails where another is withdrawn was still in its test
    uncensored = kaplan_meier(entry, end, ~failed).at(np.nextafter(end, 0)) if not failed.all() else np.ones(len(end))
    chosen, unit = lives.failed, float(np.median(np.diff(lives.age)[np.diff(lives.bearing) == 0]))
    # an early end would be chosen on snapshots of bearings of the training
    options: Any = {"loss": "absolute_error", "max_iter": 60, "max_leaf_nodes": 15, "early_stopping": False}
    # scikit-learn finds each end of a bin of weighted samples alone: 255 bins of 258 inputs take 18 s, 31 take 2 s
    model = HistGradientBoostingRegressor(max_bins=31, random_state=0, **options)
    weight = 1 / np.maximum(uncensored[place], 0.05)
    model.fit(inputs(lives)[chosen], np.log1p(lives.rul[chosen] / unit), sample_weight=weight[chosen])
    return lambda tested: unit * np.expm1(np.maximum(model.predict(inputs(tested)), 0.0))


def without_signal(lives: Lives) -> Estimate:
    """The same without features: the control of the boosting."""
    return by_boosting(lives, lambda some: some.age[:, None])


METHODS: Mapping[str, Callable[[Lives], Estimate]] = {
    "age": by_age,
    "kaplan_meier": by_kaplan_meier,
    "weibull": by_weibull,
    "without_signal": without_signal,
    "boosting": by_boosting,
}


def age_and_features(lives: Lives) -> FloatArray:
    """Age, features, and their change since the first snapshots of the bearing, shape (snapshot, input)."""
    change = np.empty_like(lives.features)
    for bearing in np.unique(lives.bearing):
        own = lives.bearing == bearing
        first = lives.features[own][:FIRST]
        # the first snapshots know only those before them
        medians = np.array([np.median(first[: count + 1], axis=0) for count in range(len(first))])
        change[own] = lives.features[own] - medians[np.minimum(np.arange(own.sum()), len(first) - 1)]
    return np.column_stack([lives.age, lives.features, change])


def score_lives(table: xr.Dataset, tested: xr.Dataset | None = None, *, folds: int = 5) -> pd.DataFrame:
    """Scores of estimates of remaining life, on bearings that they were not trained on.

    Parameters
    ----------
    table
        Feature table of a corpus of lives, as of `features.feature_table`.
    tested
        Feature table of other bearings; by default the bearings of ``table`` are tested in folds.
    folds
        Number of splits. No split parts the snapshots of a bearing.

    Returns
    -------
    DataFrame
        One row for each of `METHODS`. ``mae_50``, ``mae_75`` and ``mae_90`` are the mean absolute errors at these percents of life [s],
        ``phm_2012`` and ``alpha_lambda`` scores at them (1 is best), or at the last snapshots if no tested bearing failed,
        ``concordance`` the share of pairs of bearings in the right order, and
        ``mae_before`` the error before spalls begin [s].

    Raises
    ------
    CorpusError
        If the tables are not of lives, have a bearing in common or other features, or folds are not from 2 to the number of bearings.
    """
    lives = lives_of(table)
    if not lives.failed.any():
        raise CorpusError(_NONE_FAILED)
    if tested is not None:
        check_lives(tested, "the table of the tested bearings")
        check_others(table, tested)
        return score_methods(lives, lives_of(tested))
    estimates = {name: np.empty(len(lives.age)) for name in METHODS}
    for train, test in bearing_folds(lives.bearing, folds):
        if not lives.failed[train].any():
            raise CorpusError(
                "no bearing of the training failed in one of the folds; use more folds, or a corpus in which more fail."
            )
        for name, method in METHODS.items():
            estimates[name][test] = method(lives.some(train))(lives.some(test))
    return scores_of(lives, estimates)


def score_methods(lives: Lives, tested: Lives) -> pd.DataFrame:
    """Scores on some lives of estimates trained on others, as of `score_lives`."""
    return scores_of(tested, {name: method(lives)(tested) for name, method in METHODS.items()})


def scores_of(lives: Lives, estimates: Mapping[str, FloatArray]) -> pd.DataFrame:
    """Scores of estimates of the remaining lives, as of `score_lives`."""
    at = {f"mae_{100 * share:.0f}": _places(lives, share) for share in SHARES}
    # all places at which lives are scored; tests that end before any failure are scored at their ends, as in the challenge
    every = np.concatenate([*at.values()]) if lives.failed.any() else _last_places(lives)
    before, truth = ~lives.damaged & np.isfinite(lives.rul), lives.rul[every]
    rows = {}
    for name, estimate in estimates.items():
        error = estimate - lives.rul
        row = {score: float(np.abs(error[places]).mean()) if len(places) else np.nan for score, places in at.items()}
        # long estimates count worse than short ones
        row["phm_2012"] = float(phm_2012(truth, estimate[every]).mean())
        row["alpha_lambda"] = float((np.abs(error[every]) <= WITHIN * truth).mean())
        row["concordance"] = concordance(lives, estimate)
        rows[name] = row | {"mae_before": float(np.abs(error[before]).mean()) if before.any() else np.nan}
    return pd.DataFrame.from_dict(rows, orient="index")


def phm_2012(truth: FloatArray, estimate: FloatArray) -> FloatArray:
    """Score of estimates in the challenge of 2012: 1 without an error, and late estimates cost more than early ones [2].

    >>> phm_2012(np.array([100.0, 100.0, 100.0]), np.array([100.0, 105.0, 80.0])).round(2).tolist()
    [1.0, 0.5, 0.5]
    """
    percent = 100 * (truth - estimate) / truth
    return 0.5 ** np.where(percent <= 0, -percent / 5, percent / 20)


def concordance(lives: Lives, estimate: FloatArray) -> float:
    """Share of comparable pairs of bearings, each at one random snapshot, of which the one that fails first is estimated shorter."""
    rng, right, pairs = np.random.default_rng(0), 0.0, 0
    _, first, count = np.unique(lives.bearing, return_index=True, return_counts=True)
    _, end, _ = lives.ends
    for _ in range(_DRAWS):
        at = first + (rng.random(len(first)) * count).astype(int)
        left, own = end - lives.age[at], estimate[at]
        comparable = lives.failed[at][:, None] & (left[:, None] < left)
        right += float(((own[:, None] < own) + 0.5 * (own[:, None] == own))[comparable].sum())
        pairs += int(comparable.sum())
    return right / pairs if pairs else np.nan


def _places(lives: Lives, share: float) -> NDArray[np.intp]:
    """Snapshot of each failed bearing that is nearest to a share of its life, before its end."""
    away = np.abs(lives.age / (lives.age + lives.rul) - share)
    usable = lives.failed & (lives.rul > 0)
    nearest = [
        own[np.argmin(away[own])]
        for bearing in np.unique(lives.bearing[usable])
        if len(own := np.flatnonzero(usable & (lives.bearing == bearing)))
    ]
    return np.array(nearest, dtype=np.intp)


def _last_places(lives: Lives) -> NDArray[np.intp]:
    """Last snapshot of each bearing whose remaining life is known there."""
    last = np.append(np.flatnonzero(np.diff(lives.bearing)), len(lives.bearing) - 1)
    return last[lives.rul[last] > 0]
