"""Ranking of features: how well each tells the fault classes, and how well it follows a series to its end.

``feature table -> one row per specimen -> analysis of variance, Kruskal-Wallis, mutual information; folds -> importance``

Records of one specimen are not independent, so the three measures of one feature at a time are taken from the mean of
each specimen. Permutation importance is that of `features.baselines.importance`, on specimens outside the training. The
measures of series are those of [1]_.

.. [1] J. B. Coble, *Merging data sources to predict remaining useful life: an automated method to identify prognostic
       parameters*, PhD thesis, University of Tennessee, 2010.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
import pandas as pd
import xarray as xr
from scipy.interpolate import interp1d
from scipy.stats import kruskal, rankdata
from sklearn.feature_selection import f_classif, mutual_info_classif
from sklearn.impute import SimpleImputer

from features.baselines.importance import permutation_importance
from features.baselines.records import (
    FloatArray,
    Records,
    all_records,
    check_classes,
    check_table,
    features_of,
    labelled_records,
)
from features.baselines.tracks import track_splits
from features.signal.rows import group_means
from features.table.indicators import GROUPS
from gen.support.errors import CorpusError

MEASURES = {
    "anova_f": "F of the analysis of variance between the classes",
    "kruskal_h": "H of Kruskal and Wallis between the classes, of ranks alone",
    "mutual_information": "mutual information with the class [nat]",
    "importance": "loss of balanced accuracy when the feature is permuted",
}
"""Measures of `rank_features` and their meaning."""
SERIES_MEASURES = {
    "monotonicity": "share by which steps in one direction outnumber the others",
    "trendability": "lowest correlation of two series",
    "prognosability": "how alike the series end, for the change that each makes",
}
"""Measures of `rank_series` and their meaning."""
IMPORTANCE_ESTIMATOR = "extra_trees"
POINTS = 100  # that the series of a trend are compared at


def rank_features(
    table: xr.Dataset, groups: Sequence[str] | None = None, *, folds: int = 5, seed: int = 0
) -> pd.DataFrame:
    """Features of a table by how well they tell the fault classes, the best first.

    Parameters
    ----------
    table
        Feature table, as of `features.feature_table`; records of class ``unknown`` are left out.
    groups
        Groups of features that are ranked, by default all that the table has.
    folds
        Splits by specimen of the permutation importance.
    seed
        Of splits, classifier and permutations.

    Returns
    -------
    DataFrame
        One row per feature, by name, with its ``group``, the measures of `MEASURES`, and ``mean_rank``, the mean of its ranks in
        the first three, by which the rows are sorted. A measure is NaN for a feature that is the same for all specimens.

    Raises
    ------
    CorpusError
        If the table has one class, or too few specimens for the folds.
    """
    held = _held(table, groups)
    records = labelled_records(table, features_of(table, held))
    check_classes(records)
    splits = track_splits(records, records.fault, "specimen", folds, seed)
    single = [[column] for column in range(records.features.shape[1])]
    losses = permutation_importance(records, single, IMPORTANCE_ESTIMATOR, splits, seed)
    measures = {**_of_specimens(records, seed), "importance": losses}
    ranked = _named(table, held, measures)
    ranked["mean_rank"] = rankdata(-ranked[list(MEASURES)[:-1]].fillna(-np.inf), axis=0).mean(axis=1)
    return ranked.sort_values("mean_rank", kind="stable")


def rank_series(table: xr.Dataset, groups: Sequence[str] | None = None) -> pd.DataFrame:
    """Features of a table by how well they follow specimens from their first recording to their last, the best first.

    A specimen is a series of recordings, in the order of their numbers; its last one is its end. A feature that is
    missing in a recording has no measure.

    Parameters
    ----------
    table
        Feature table of two or more specimens of three or more recordings each, such as runs to failure.
    groups
        Groups of features that are ranked, by default all that the table has.

    Returns
    -------
    DataFrame
        One row per feature, by name, with its ``group`` and the measures of `SERIES_MEASURES`, each from 0 to 1, and
        ``fitness``, their sum, by which the rows are sorted.

    Raises
    ------
    CorpusError
        If there are fewer than two series, or one has fewer than three recordings.
    """
    held = _held(table, groups)
    records = all_records(table, features_of(table, held))
    number = table["recording"].values
    values = records.features.to_numpy()
    series = [
        group_means(values[of_one], number[of_one])
        for of_one in (records.specimen == one for one in np.unique(records.specimen))
    ]
    if len(series) < 2 or min(map(len, series)) < 3:
        raise CorpusError(
            f"{records.title}: {len(series)} specimen(s) of {min(map(len, series))} recording(s) or more are no series; give two "
            f"or more of three or more."
        )
    ranked = _named(table, held, series_measures(series))
    ranked["fitness"] = ranked[list(SERIES_MEASURES)].sum(axis=1)
    return ranked.sort_values("fitness", kind="stable", ascending=False)


def series_measures(series: Sequence[FloatArray]) -> dict[str, FloatArray]:
    """Values of `SERIES_MEASURES`, each of shape (feature,), from two or more series of shape (time, feature).

    Monotonicity is the mean over the series of the modulus of the mean sign of a step. Trendability is the lowest modulus
    of the correlation of two series, which are compared at `POINTS` equally spaced points. Prognosability is
    ``exp(-s / m)``, with the standard deviation s of the last values and the mean modulus m of the change from the first
    value to the last.
    """
    monotonicity = np.mean([np.abs(np.sign(np.diff(one, axis=0)).mean(axis=0)) for one in series], axis=0)
    first, last = (np.stack([one[place] for one in series]) for place in (0, -1))
    with np.errstate(divide="ignore", invalid="ignore"):
        prognosability = np.exp(-last.std(axis=0, ddof=1) / np.abs(first - last).mean(axis=0))
        even = [interp1d(np.linspace(0, 1, len(one)), one, axis=0)(np.linspace(0, 1, POINTS)) for one in series]
        standard = [(one - one.mean(axis=0)) / one.std(axis=0) for one in even]
        trendability = np.min([np.abs(np.mean(a * b, axis=0)) for a, b in combinations(standard, 2)], axis=0)
    return dict(zip(SERIES_MEASURES, (monotonicity, trendability, prognosability), strict=True))


def _held(table: xr.Dataset, groups: Sequence[str] | None) -> Sequence[str]:
    check_table(table)
    return [group for group in GROUPS if group in table["group"].values] if groups is None else groups


def _named(table: xr.Dataset, groups: Sequence[str], measures: Mapping[str, FloatArray]) -> pd.DataFrame:
    """Measures by name of the feature, with its group; one of several channels is named after its channel too."""
    group = table["group"].to_series()[lambda of: of.isin(groups)]
    channels = [f"{name} " for name in table["channel"].values] if table["features"].ndim > 2 else [""]
    named = pd.Index([f"{channel}{name}" for channel in channels for name in group.index], name="feature")
    return pd.DataFrame({"group": np.tile(group.to_numpy(), len(channels)), **measures}, index=named)


def _of_specimens(records: Records, seed: int) -> dict[str, FloatArray]:
    """Measures of one feature at a time, each of shape (feature,), from the means of specimens."""
    _, number = np.unique(np.stack([records.specimen, records.fault]), axis=1, return_inverse=True)
    means = group_means(records.features.to_numpy(), number.reshape(-1))
    fault = group_means(records.fault[:, None].astype(float), number.reshape(-1))[:, 0].astype(int)
    filled = SimpleImputer(strategy="median", keep_empty_features=True).fit_transform(means)
    varying = np.ptp(filled, axis=0) > 0
    found = {name: np.full(len(varying), np.nan) for name in ("anova_f", "kruskal_h", "mutual_information")}
    rows = filled[:, varying]
    found["anova_f"][varying] = f_classif(rows, fault)[0]
    found["kruskal_h"][varying] = kruskal(*(rows[fault == c] for c in np.unique(fault)), axis=0).statistic
    found["mutual_information"][varying] = mutual_info_classif(rows, fault, random_state=seed)
    return found
