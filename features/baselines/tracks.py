"""Tracks: for each kind of novelty, splits whose tested records are new in that respect.

All records of a specimen are on one side of every split of every track, because they share geometry, transfer path and
background. On the tracks *specimen*, *rig* and *bearing* the groups are dealt out to folds of equal size. On the tracks
*speed*, *severity* and *shape* each fold tests one group: a range of shaft rates, a range of fault widths, or a shape
of faults.

A specimen can have records in several groups, such as several speeds. It is then tested in the group of one of its
records, drawn at random. Its other records are left out of that fold, and train in no other group than theirs.

Healthy records have no severity and no shape. A class with a single group cannot be held out either, because every
tested class must be trained. On the tracks *severity* and *shape* the specimens of these records are dealt out to the
groups evenly.
"""

from collections.abc import Sequence

import numpy as np
from sklearn.model_selection import StratifiedGroupKFold

from features.baselines.names import Track
from features.baselines.records import FloatArray, IntArray, Records, check_classes
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY
from gen.support.errors import CorpusError

Split = tuple[IntArray, IntArray]

NOVELTY = {
    "specimen": "specimens",
    "rig": "rigs",
    "bearing": "bearing types",
    "speed": "speed ranges",
    "severity": "fault widths",
    "shape": "fault shapes",
}
"""Plural of the groups of a track, for people."""

LEFT_OUT = -1
DEALT = -2


def track_splits(records: Records, labels: IntArray, track: Track, folds: int, seed: int) -> list[Split]:
    """Training and test records of each fold of a track.

    Parameters
    ----------
    records
        The records.
    labels
        Labels to be balanced among folds where groups are dealt out, shape (record,): the classes, or permuted ones.
    track
        A name of `features.baselines.TRACKS`.
    folds
        Number of splits and of ranges; fewer where a track has fewer groups.
    seed
        Of the random choices.

    Raises
    ------
    CorpusError
        If the records cannot be split so.
    """
    check_track(records, track, folds)
    if track in ("specimen", "rig"):
        splits = grouped_splits(labels, getattr(records, track), folds, seed)
    elif track == "bearing":
        bearing = _of_first_record(records.conditions["bearing"], records.specimen)
        splits = grouped_splits(labels, bearing, min(folds, len(np.unique(bearing))), seed)
    else:
        splits = _one_group_per_fold(*held_out_groups(records, track, folds, seed))
    for train, test in splits:
        check_disjoint(records.specimen, train, test)
    return splits


def check_track(records: Records, track: Track, folds: int) -> None:
    """Refuse records that cannot be cross-validated on a track.

    Raises
    ------
    CorpusError
        If there are too few folds, groups or classes, or too few groups or records of a class.
    """
    where = f"{records.title}, cross-validation"
    present = check_classes(records)
    if folds < 2:
        raise CorpusError(f"{where}: {folds} folds are too few; use 2 or more.")
    # ranges and shapes are dealt out later, and can fill any number of folds
    if track not in ("specimen", "rig", "bearing"):
        return
    group = records.conditions[track] if track == "bearing" else getattr(records, track)
    count, name = len(np.unique(group)), "bearing type" if track == "bearing" else track
    if count < (2 if track == "bearing" else folds):
        advice = f"use at most {count} folds" if count > 1 else "test on another corpus instead"
        raise CorpusError(f"{where}: {count} {name}(s) cannot fill {folds} folds; {advice}.")
    # a class whose groups are all in one fold is never both trained and tested
    for c in present:
        fault, of_class = FAULTS[c], group[records.fault == c]
        if len(np.unique(of_class)) < 2:
            raise CorpusError(
                f"{where}: all {fault} records are of one {name}, so that the fold that tests it has none to train on; "
                f"give a corpus with two or more, or test on another corpus instead."
            )
        if len(of_class) < folds:
            raise CorpusError(f"{where}: {len(of_class)} {fault} record(s) for {folds} folds; use fewer folds.")


def grouped_splits(fault: IntArray, group: IntArray, folds: int, seed: int) -> list[Split]:
    """Training and test records of each fold, with classes balanced as evenly as the groups allow."""
    splitter = StratifiedGroupKFold(folds, shuffle=True, random_state=seed)
    splits: list[Split] = list(splitter.split(np.zeros((len(fault), 1)), fault, group))
    for train, test in splits:
        check_disjoint(group, train, test)
    return splits


def held_out_groups(records: Records, track: Track, folds: int, seed: int) -> tuple[IntArray, IntArray]:
    """Group of each record, and group in which its specimen is tested, both of shape (record,); `LEFT_OUT` is in none.

    Raises
    ------
    CorpusError
        If there is only one group.
    """
    group = _speed_ranges(records, folds) if track == "speed" else _fault_groups(records, track, folds)
    groups = np.unique(group[group >= 0])
    if len(groups) < 2:
        what = {
            "speed": "labelled shaft rate",
            "severity": "known fault width of a class",
            "shape": "known fault shape",
        }
        raise CorpusError(
            f"{records.title}, track {track}: there is only one {what[track]}, or none; choose another track, or test on another corpus."
        )
    # a specimen with records in several groups is tested in that of one of them, drawn at random
    rng = np.random.default_rng(seed)
    shuffled = rng.permutation(np.flatnonzero(group >= 0))
    specimens, first = np.unique(records.specimen[shuffled], return_index=True)
    home = np.full(records.specimen.max() + 1, LEFT_OUT)
    home[specimens] = group[shuffled[first]]
    # specimens without a group of their own are dealt out in turn, class by class
    dealt = group == DEALT
    for c in np.unique(records.fault[dealt]):
        free = np.unique(records.specimen[dealt & (records.fault == c) & (home[records.specimen] == LEFT_OUT)])
        home[rng.permutation(free)] = groups[np.arange(len(free)) % len(groups)]
    tested = home[records.specimen]
    return np.where(dealt, tested, group), tested


def _one_group_per_fold(group: IntArray, tested: IntArray) -> list[Split]:
    """Splits that test a group each, on the specimens that are tested in it, and train others in other groups."""
    placed = (group != LEFT_OUT) & (tested != LEFT_OUT)
    return [
        (np.flatnonzero(placed & (group != g) & (tested != g)), np.flatnonzero((group == g) & (tested == g)))
        for g in np.unique(tested[placed])
    ]


def _speed_ranges(records: Records, folds: int) -> IntArray:
    shaft_rate = records.conditions["shaft_rate"]
    known = shaft_rate > 0
    group = np.full(len(known), LEFT_OUT)
    group[known] = ranges(shaft_rate[known], folds)
    return group


def _fault_groups(records: Records, track: Track, folds: int) -> IntArray:
    """Range of widths within its class, or shape, of each record; `DEALT` for a class with fewer than two of them."""
    shape = records.conditions["shape"]
    group = np.full(len(records.fault), LEFT_OUT)
    group[records.width == 0] = DEALT
    group[records.fault == FAULTS.index(HEALTHY)] = DEALT
    for c in np.unique(records.fault):
        known = (records.fault == c) & ((records.width > 0) if track == "severity" else (shape >= 0))
        if known.any():
            groups = ranges(records.width[known], folds) if track == "severity" else shape[known]
            group[known] = groups if len(np.unique(groups)) > 1 else DEALT
    return group


def ranges(values: FloatArray, count: int) -> IntArray:
    """Number of the range of each value, from 0, for ``count`` ranges with about as many values each.

    If there are no more than ``count`` distinct values, each is a range.

    >>> ranges(np.array([0.5, 7.0, 7.0, 1.0]), 3).tolist(), ranges(np.arange(6.0), 3).tolist()
    ([0, 2, 2, 1], [0, 0, 1, 1, 2, 2])
    """
    distinct, number = np.unique(values, return_inverse=True)
    if len(distinct) <= count:
        return number
    edges = np.quantile(values, np.arange(1, count) / count)
    return np.unique(np.searchsorted(edges, values, side="right"), return_inverse=True)[1]


def _of_first_record(values: IntArray, specimen: IntArray) -> IntArray:
    """Value of the first record of each specimen, for all of its records, shape (record,)."""
    _, first, number = np.unique(specimen, return_index=True, return_inverse=True)
    return values[first][number]


def check_taught(fault: IntArray, splits: Sequence[Split]) -> None:
    """Refuse splits if one of them has a tested class without a training record.

    Raises
    ------
    CorpusError
        With the name of the first such class.
    """
    tested = fault[np.concatenate([test for _, test in splits])]
    for train, _ in splits:
        untaught = np.setdiff1d(tested, fault[train])
        if len(untaught):
            name = FAULTS[untaught[0]]
            message = f"cross-validation: a fold has no {name} record to train on; use fewer folds, or another track."
            raise CorpusError(message)


def check_disjoint(group: IntArray, train: IntArray, test: IntArray) -> None:
    """Refuse a split that has a group on both sides.

    Raises
    ------
    CorpusError
        With the number of the first such group.
    """
    shared = np.intersect1d(group[train], group[test])
    if len(shared):
        message = f"split: group {shared[0]} is in training and in test; keep all its records on one side."
        raise CorpusError(message)
