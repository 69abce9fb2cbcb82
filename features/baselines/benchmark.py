"""Every baseline on one corpus, each number beside the controls that say what it is worth.

Beside the score on unseen specimens (or rigs) stand a split of random records, which leaks, the same scores after
the labels were permuted among specimens, which must be at chance, and the scores on another corpus.
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
    title_of,
)
from features.baselines.scores import Scores
from features.baselines.splits import Grouping, check_groups, grouped_splits, score_splits
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
    """Scores of one estimator: by group, and the controls; ``test`` is on the other corpus, if there is one."""

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
    if test is not None:
        _check_apart(table, test, names)
    group = getattr(records, by)
    splits = grouped_splits(records.fault, group, folds, seed)
    leaking = grouped_splits(records.fault, np.arange(len(group)), folds, seed)
    permuted = permuted_labels(records, seed)
    null = grouped_splits(permuted, group, folds, seed)
    baselines: dict[str, Baseline] = {}
    for done, name in enumerate(ESTIMATORS, start=1):
        baselines[name] = Baseline(
            grouped=score_splits(records, records.fault, name, splits, seed),
            leaky=score_splits(records, records.fault, name, leaking, seed),
            null=score_splits(records, permuted, name, null, seed),
            test=None
            if test is None
            else evaluate(test, train(table, name, groups=groups, seed=seed), seed=seed),
        )
        if progress is not None:
            progress(done, len(ESTIMATORS))
    return Results(
        corpus=_content(table, records),
        test=None if test is None else _content(test, labelled_records(test, names)),
        by=by,
        folds=folds,
        seed=seed,
        groups=tuple(groups),
        features=len(names),
        versions={library: version(library) for library in ("raceway", "scikit-learn", "numpy", "scipy")},
        baselines=baselines,
    )


def permuted_labels(records: Records, seed: int) -> IntArray:
    """Labels dealt anew among specimens: each keeps one label for all its records, but not its own.

    A specimen recorded healthy and faulty counts as two.
    """
    rng = np.random.default_rng(seed)
    units, number = np.unique(np.stack([records.specimen, records.fault]), axis=1, return_inverse=True)
    return rng.permutation(units[1])[number.reshape(-1)]


def _check_apart(table: xr.Dataset, test: xr.Dataset, names: Sequence[str]) -> None:
    digests = record_digests(labelled_records(table, names).features.to_numpy())
    shared = seen_records(labelled_records(test, names).features.to_numpy(), digests)
    if shared:
        message = (
            f"{title_of(test)}: {shared} of its records are in the training corpus too; "
            f"test on records the models have not seen."
        )
        raise CorpusError(message)


def _content(table: xr.Dataset, records: Records) -> Content:
    counts = np.bincount(records.fault, minlength=len(FAULTS))
    return Content(
        title=title_of(table),
        records=len(records.fault),
        recordings=len(np.unique(records.recording)),
        specimens=len(np.unique(records.specimen)),
        rigs=len(np.unique(records.rig)),
        classes={fault: int(count) for fault, count in zip(FAULTS, counts, strict=True) if count},
    )


def write_results(results: Results, path: Path) -> None:
    """Write results as JSON, whole or not at all."""
    write_text_durably(json.dumps(asdict(results), indent=1, allow_nan=False) + "\n", path)
