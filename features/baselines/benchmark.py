"""Scores of every baseline on one corpus, with the controls that a reader needs to judge them.

The score on specimens (or rigs) outside the training is reported with three others: the score of a random split of
records, which leaks; the grouped score with labels permuted among specimens, which must be at chance; and the score on
another corpus.
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
    count_unknown,
    features_of,
    labelled_records,
)
from features.baselines.scores import Scores
from features.baselines.severities import Widths, uncovered_in_splits
from features.baselines.splits import Grouping, Split, check_groups, check_taught, grouped_splits, score_splits
from gen.corpus import FAULTS, write_text_durably
from gen.errors import CorpusError

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Content:
    """Title and counts of a benchmarked corpus; ``classes`` counts records, ``unknown`` those left out because their class is not known."""

    title: str
    records: int
    recordings: int
    specimens: int
    rigs: int
    classes: dict[str, int]
    unknown: int = 0


@dataclass(frozen=True)
class Baseline:
    """Scores of one estimator: cross-validated by group, of both controls, and on the other corpus if there is one."""

    grouped: Scores
    leaky: Scores
    null: Scores
    test: Scores | None


@dataclass(frozen=True)
class Results:
    """Results of a benchmark, all of plain types.

    Attributes
    ----------
    corpus, test
        The corpus, and the other corpus if there is one.
    by, folds
        Of the grouped cross-validation.
    seed
        Of splits, estimators, permutation and bootstrap.
    groups, features
        Groups and number of the features.
    versions
        Of the libraries.
    baselines
        Scores by name of the estimator.
    uncovered_widths
        Fault widths [m] by class that a fold of the grouped cross-validation tests and does not train. Those of the
        other corpus are in its scores.
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
    uncovered_widths: Widths


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
        Feature table of another corpus, such as recordings of a real machine, without records of ``table``.
    by
        Groups that a split must not divide.
    folds
        Number of splits.
    groups
        Groups of features.
    seed
        Of splits, estimators, permutation and bootstrap.
    progress
        Called after each baseline with the number of baselines done and of all.

    Raises
    ------
    CorpusError
        If the table cannot be cross-validated (see ``cross_validate``), or shares records with ``test``.
    """
    names = features_of(table, groups)
    records = labelled_records(table, names)
    check_groups(records, by, folds)
    other = None if test is None else labelled_records(test, names)
    if other is not None:
        _check_apart(records, other)
    cases = _cases(records, by, folds, seed)
    baselines: dict[str, Baseline] = {}
    for done, name in enumerate(ESTIMATORS, start=1):
        scores = {case: score_splits(records, labels, name, splits, seed) for case, (labels, splits) in cases.items()}
        tested = None if test is None else evaluate(test, train(table, name, groups=groups, seed=seed), seed=seed)
        baselines[name] = Baseline(**scores, test=tested)
        if progress is not None:
            progress(done, len(ESTIMATORS))
    return Results(
        corpus=_content(records, count_unknown(table)),
        test=None if test is None or other is None else _content(other, count_unknown(test)),
        by=by,
        folds=folds,
        seed=seed,
        groups=tuple(groups),
        features=len(names),
        versions={library: version(library) for library in ("raceway", "scikit-learn", "numpy", "scipy")},
        baselines=baselines,
        uncovered_widths=uncovered_in_splits(records, cases["grouped"][1]),
    )


def _cases(records: Records, by: Grouping, folds: int, seed: int) -> dict[str, tuple[IntArray, list[Split]]]:
    """Labels and splits of the cross-validation by group, of the leaky one, and of the one with permuted labels."""
    fault, group, permuted = records.fault, getattr(records, by), permuted_labels(records, seed)
    grouped = grouped_splits(fault, group, folds, seed)
    leaky = grouped_splits(fault, np.arange(len(group)), folds, seed)
    for splits in (grouped, leaky):
        check_taught(fault, splits)
    null = grouped_splits(permuted, group, folds, seed)
    return {"grouped": (fault, grouped), "leaky": (fault, leaky), "null": (permuted, null)}


def permuted_labels(records: Records, seed: int) -> IntArray:
    """Labels permuted among specimens, so that all records of a specimen still share one label, shape (record,).

    A specimen that was recorded healthy and faulty counts as two.
    """
    rng = np.random.default_rng(seed)
    units, number = np.unique(np.stack([records.specimen, records.fault]), axis=1, return_inverse=True)
    return rng.permutation(units[1])[number.reshape(-1)]


def _check_apart(records: Records, test: Records) -> None:
    shared = seen_records(test.features.to_numpy(), record_digests(records.features.to_numpy()))
    if shared:
        message = (
            f"{test.title}: {shared} of its records are in the training corpus too; "
            f"give a test corpus without training records."
        )
        raise CorpusError(message)


def _content(records: Records, unknown: int) -> Content:
    counts = np.bincount(records.fault, minlength=len(FAULTS))
    return Content(
        title=records.title,
        records=len(records.fault),
        recordings=len(np.unique(records.recording)),
        specimens=len(np.unique(records.specimen)),
        rigs=len(np.unique(records.rig)),
        classes={fault: int(count) for fault, count in zip(FAULTS, counts, strict=True) if count},
        unknown=unknown,
    )


def write_results(results: Results, path: Path) -> None:
    """Write results as JSON, whole or not at all."""
    write_text_durably(json.dumps(asdict(results), indent=1, allow_nan=False) + "\n", path)
