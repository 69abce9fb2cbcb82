"""Tracks: for each kind of novelty, splits whose tested records are new in that respect.

All records of a specimen are on one side of every split of every track, because they share geometry, transfer path and
background. On the tracks *specimen*, *rig* and *bearing* the groups are dealt out to folds of equal size. On the track
*speed* each fold tests a range of shaft rates.

A specimen can have records at several speeds. It is then tested in the range of one of its records, drawn at random. Its
other records are left out of that fold, and train in no other range than theirs.
"""

from collections.abc import Sequence

import numpy as np
from sklearn.model_selection import StratifiedGroupKFold

from features.baselines.names import TRACKS, Track
from features.baselines.records import FloatArray, IntArray, Records, check_classes
from gen.corpus import FAULTS
from gen.support.errors import CorpusError

Split = tuple[IntArray, IntArray]

NOVELTY = {"specimen": "specimens", "rig": "rigs", "bearing": "bearing types", "speed": "speed ranges"}
"""Plural of the groups of a track, for people."""

LEFT_OUT = -1


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
    if track == "speed":
        return speed_splits(records, folds, seed)
    group = getattr(records, track)
    return grouped_splits(labels, group, min(folds, len(np.unique(group))), seed)


def check_track(records: Records, track: Track, folds: int) -> None:
    """Refuse records that cannot be cross-validated on a track.

    Raises
    ------
    CorpusError
        If there are too few folds, groups or classes, or too few groups or records of a class.
    ValueError
        For a track that does not exist.
    """
    if track not in TRACKS:
        raise ValueError(f"track: {track!r} does not exist; choose from {', '.join(TRACKS)}.")
    where = f"{records.title}, cross-validation"
    present = check_classes(records)
    if folds < 2:
        raise CorpusError(f"{where}: {folds} folds are too few; use 2 or more.")
    if track == "speed":
        return
    group, name = getattr(records, track), "bearing type" if track == "bearing" else track
    count = len(np.unique(group))
    # there are few types of bearings, so their number may set that of the folds
    if count < (2 if track == "bearing" else folds):
        # fewer folds do not help a class of one group
        fewest = min(len(np.unique(group[records.fault == c])) for c in present)
        advice = f"use at most {count} folds" if fewest > 1 else "test on another corpus instead"
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
    return list(splitter.split(np.zeros((len(fault), 1)), fault, group))


def speed_splits(records: Records, folds: int, seed: int) -> list[Split]:
    """Splits that test a range of shaft rates each, and train other specimens in other ranges.

    Raises
    ------
    CorpusError
        If there is only one range.
    """
    with_rate = records.shaft_rate > 0
    group = np.full(len(with_rate), LEFT_OUT)
    group[with_rate] = ranges(records.shaft_rate[with_rate], folds)
    if len(np.unique(group[with_rate])) < 2:
        raise CorpusError(
            f"{records.title}, track speed: there is only one labelled shaft rate, or none; choose another track, or test on "
            "another corpus."
        )
    # a specimen with records in several ranges is tested in that of one of them, drawn at random
    shuffled = np.random.default_rng(seed).permutation(np.flatnonzero(with_rate))
    specimens, first = np.unique(records.specimen[shuffled], return_index=True)
    home = np.full(records.specimen.max() + 1, LEFT_OUT)
    home[specimens] = group[shuffled[first]]
    tested = home[records.specimen]
    return [
        (np.flatnonzero(with_rate & (group != g) & (tested != g)), np.flatnonzero((group == g) & (tested == g)))
        for g in np.unique(tested[with_rate])
    ]


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
            raise CorpusError(
                f"cross-validation: a fold has no {name} record to train on; use fewer folds, or another track."
            )
