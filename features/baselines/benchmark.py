"""Every baseline on one corpus, each number beside the controls that say what it is worth.

Beside the score on unseen specimens (or rigs) stand a split of random records, which leaks, the grouped score
after the labels were permuted among specimens, which must be at chance, and the score on another corpus.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import xarray as xr

from features.baselines.estimators import ESTIMATORS
from features.baselines.models import evaluate, record_digests, seen_records, train
from features.baselines.records import (
    DEFAULT_GROUPS,
    IntArray,
    Records,
    features_of,
    labelled_records,
)
from features.baselines.scores import Scores
from features.baselines.splits import Grouping, check_groups, check_taught, grouped_splits, score_splits
from gen.corpus import FAULTS, write_text_durably
from gen.errors import CorpusError

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Content:
    """What a benchmarked corpus holds."""

    title: str
    records: int
    recordings: int
    specimens: int
    rigs: int
    classes: dict[str, int]


@dataclass(frozen=True)
class Baseline:
    """Scores of one estimator: by group, its controls, and on the other corpus if there is one."""

    grouped: Scores
    leaky: Scores
    null: Scores
    test: Scores | None


@dataclass(frozen=True)
class Results:
    """Results of a benchmark, all of plain types.

    ``by`` and ``folds`` are those of the grouped cross-validation, ``groups`` and ``features`` what the estimators
    were given, ``test`` describes the other corpus.
    """

    corpus: Content
    test: Content | None
    by: str
    folds: int
    seed: int
    groups: tuple[str, ...]
    features: int
    versions: dict[str, str]
    baselines: dict[str, Baseline]


def benchmark(
    table: xr.Dataset,
    test: xr.Dataset | None = None,
    *,
    by: Grouping = "specimen",
    folds: int = 5,
    groups: Sequence[str] = DEFAULT_GROUPS,
    seed: int = 0,
    progress: Progress | None = None,
) -> Results:
    """Cross-validate every baseline with its controls, and test it on another corpus.

    Parameters
    ----------
    table
        Feature table of the corpus.
    test
        Feature table of another corpus, such as recordings of a real machine; none of its records may be in
        ``table``.
    by
        What stays on one side of every split.
    folds
        Number of splits.
    groups
        Groups of features.
    seed
        Of splits, estimators, permutation and bootstrap.
    progress
        Called after each baseline with the number done and of all.

    Raises
    ------
    CorpusError
        If the table cannot be cross-validated (see ``cross_validate``), or shares records with ``test``.
    """
    names = features_of(table, groups)
    records = labelled_records(table, names)
    check_groups(records, by, folds)
    strange = None if test is None else labelled_records(test, names)
    if strange is not None:
        _check_apart(records, strange)
    group = getattr(records, by)
    splits = grouped_splits(records.fault, group, folds, seed)
    leaking = grouped_splits(records.fault, np.arange(len(group)), folds, seed)
    for found in (splits, leaking):
        check_taught(records.fault, found)
    permuted = permuted_labels(records, seed)
    null = grouped_splits(permuted, group, folds, seed)
    baselines: dict[str, Baseline] = {}
    for done, name in enumerate(ESTIMATORS, start=1):
        baselines[name] = Baseline(
            grouped=score_splits(records, records.fault, name, splits, seed),
            leaky=score_splits(records, records.fault, name, leaking, seed),
            null=score_splits(records, permuted, name, null, seed),
            test=None if test is None else evaluate(test, train(table, name, groups=groups, seed=seed), seed=seed),
        )
        if progress is not None:
            progress(done, len(ESTIMATORS))
    return Results(
        corpus=_content(records),
        test=None if strange is None else _content(strange),
        by=by,
        folds=folds,
        seed=seed,
        groups=tuple(groups),
        features=len(names),
        versions={library: version(library) for library in ("raceway", "scikit-learn", "numpy", "scipy")},
        baselines=baselines,
    )


def permuted_labels(records: Records, seed: int) -> IntArray:
    """Labels dealt anew among specimens, each still with one label for all its records, shape (record,).

    A specimen recorded healthy and faulty counts as two.
    """
    rng = np.random.default_rng(seed)
    units, number = np.unique(np.stack([records.specimen, records.fault]), axis=1, return_inverse=True)
    return rng.permutation(units[1])[number.reshape(-1)]


def _check_apart(records: Records, test: Records) -> None:
    shared = seen_records(test.features.to_numpy(), record_digests(records.features.to_numpy()))
    if shared:
        message = (
            f"{test.title}: {shared} of its records are in the training corpus too; "
            f"test on records the models have not seen."
        )
        raise CorpusError(message)


def _content(records: Records) -> Content:
    counts = np.bincount(records.fault, minlength=len(FAULTS))
    return Content(
        title=records.title,
        records=len(records.fault),
        recordings=len(np.unique(records.recording)),
        specimens=len(np.unique(records.specimen)),
        rigs=len(np.unique(records.rig)),
        classes={fault: int(count) for fault, count in zip(FAULTS, counts, strict=True) if count},
    )


def write_results(results: Results, path: Path) -> None:
    """Write results as JSON, whole or not at all."""
    write_text_durably(json.dumps(asdict(results), indent=1, allow_nan=False) + "\n", path)
