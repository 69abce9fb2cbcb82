"""Ranking of features by what a classifier loses without them, on specimens outside its training."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr

from features.baselines.inspection import permutation_losses
from features.baselines.records import check_classes, check_table, features_of, labelled_records
from features.baselines.tracks import track_splits
from features.table.definitions import ALL_GROUPS

IMPORTANCE_ESTIMATOR = "extra_trees"


def rank_features(
    table: xr.Dataset, groups: Sequence[str] | None = None, *, folds: int = 5, seed: int = 0
) -> pd.DataFrame:
    """Features of a table by their permutation importance, the most important first.

    Parameters
    ----------
    table
        Feature table, as of `features.feature_table`; records of class ``unknown`` are left out.
    groups
        Groups of features that are ranked, by default all that the table has.
    folds
        Splits by specimen.
    seed
        Of splits, classifier and permutations.

    Returns
    -------
    DataFrame
        One row per feature, by name, with its ``group``, its ``importance``, the balanced accuracy that extra trees lose when its
        values are permuted among the tested records, and the ``deviation`` of that over the folds. Features that replace one
        another share their importance, down to 0.

    Raises
    ------
    CorpusError
        If the table has one class, or too few specimens for the folds.
    """
    check_table(table)
    held = [group for group in ALL_GROUPS if group in table["group"].values] if groups is None else groups
    records = labelled_records(table, features_of(table, held))
    check_classes(records)
    splits = track_splits(records, records.fault, "specimen", folds, seed)
    # each column by itself: features that replace one another all rank low
    single = [[column] for column in range(records.features.shape[1])]
    losses = permutation_losses(records, single, IMPORTANCE_ESTIMATOR, splits, seed)
    group = table["group"].to_series()[lambda of: of.isin(held)]
    channels = [f"{name} " for name in table["channel"].values] if table["features"].ndim > 2 else [""]
    ranked = pd.DataFrame(
        {"group": np.tile(group, len(channels)), "importance": losses.mean(axis=0), "deviation": losses.std(axis=0)},
        index=pd.Index([f"{channel}{name}" for channel in channels for name in group.index], name="feature"),
    )
    return ranked.sort_values("importance", kind="stable", ascending=False)
