"""Learning curve: score of a classifier against the number of its training specimens.

The tested records are those of the cross-validation. Each training set is cut down to ever fewer specimens, nested: a
smaller set is part of each larger one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from features.baselines.own import Maker
from features.baselines.records import DEFAULT_GROUPS, IntArray, Records, records_of
from features.baselines.scores import Scores
from features.baselines.splits import grouped_case, score_splits
from features.baselines.tracks import Split
from features.table.waveforms import Waveforms

LEAST_OF_A_CLASS = 2  # training specimens of a class in the smallest set, on average


@dataclass(frozen=True)
class CurvePoint:
    """Scores with a number of training ``specimens`` in each fold; ``records`` is the mean number of training records."""

    specimens: int
    records: float
    scores: Scores


def learning_curve(
    data: xr.Dataset | Waveforms,
    estimator: str | Maker,
    *,
    folds: int = 5,
) -> tuple[CurvePoint, ...]:
    """Scores against the number of training specimens, which doubles from point to point up to all of them.

    The tested specimens are new. The parameters and errors are those of `cross_validate`.
    """
    records = records_of(data, DEFAULT_GROUPS)
    return curve_points(records, estimator, grouped_case(records, "specimen", folds, seed=0)[1], seed=0)


def curve_points(
    records: Records,
    estimator: str | Maker,
    splits: Sequence[Split],
    seed: int,
    done: Callable[[int], None] = lambda _: None,
) -> tuple[CurvePoint, ...]:
    """Points of the learning curve on given splits; ``done`` is called with 1 after each."""
    orders = [nested_specimens(records.at(train), seed) for train, _ in splits]
    points: list[CurvePoint] = []
    for size in curve_sizes(records, splits):
        smaller = [
            (train[np.isin(records.specimen[train], order[:size])], test)
            for order, (train, test) in zip(orders, splits, strict=True)
        ]
        scores = score_splits(records, records.fault, estimator, smaller, seed)
        points.append(CurvePoint(size, float(np.mean([len(train) for train, _ in smaller])), scores))
        done(1)
    return tuple(points)


def curve_sizes(records: Records, splits: Sequence[Split]) -> list[int]:
    """Numbers of training specimens: each about twice the one before, the last that of the smallest training set."""
    largest = min(len(np.unique(records.specimen[train])) for train, _ in splits)
    smallest = min(LEAST_OF_A_CLASS * len(np.unique(records.fault)), largest)
    count = 1 + max(1, round(np.log2(largest / smallest)))
    return [int(size) for size in np.unique(np.rint(np.geomspace(smallest, largest, count)))]


def nested_specimens(records: Records, seed: int) -> IntArray:
    """Specimens in an order in which all first ones have the classes about as often as all, shape (specimen,).

    One specimen of each class comes first. A specimen that was recorded healthy and faulty counts as faulty.
    """
    specimens, number = np.unique(records.specimen, return_inverse=True)
    fault = np.zeros(len(specimens), dtype=np.intp)
    np.maximum.at(fault, number, records.fault)
    shuffled = np.random.default_rng(seed).permutation(len(specimens))
    place = np.zeros(len(specimens))
    for c in np.unique(fault):
        of_class = shuffled[fault[shuffled] == c]
        place[of_class] = np.arange(len(of_class)) / len(of_class)
    return specimens[shuffled[np.argsort(place[shuffled], kind="stable")]]
