"""Scores of classifiers on one corpus, with the controls that a reader needs to judge them.

The score on specimens (or rigs, or other groups of a track) outside the training is reported with three others: the
score of a random split of records, which leaks; the grouped score with labels permuted among specimens, which must be
at chance; and the scores on other corpora.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib.metadata import version
from typing import Any, Literal

import xarray as xr

from features.baselines.inspection import permutation_losses
from features.baselines.models import Model
from features.baselines.names import BASELINES, DEFAULT_ESTIMATOR, TRACKS, UNTRAINED, Track
from features.baselines.own import Maker
from features.baselines.records import (
    DEFAULT_GROUPS,
    FloatArray,
    Records,
    count_unknown,
    features_of,
    labelled_records,
    record_digests,
    records_of,
    seen_records,
)
from features.baselines.scores import Scores, ends_of, interval_text
from features.baselines.splits import Case, control_cases, grouped_case, score_splits
from features.baselines.tracks import Split
from features.table.definitions import measured_quantity
from features.table.waveforms import Waveforms
from gen.corpus import class_counts, unit_counts
from gen.support.display import Shown
from gen.support.errors import CorpusError
from gen.support.executor import run
from gen.support.progress import Progress, counter

_CASES = ("grouped", "leaky", "null", "tests")
BRIEF = (*UNTRAINED, DEFAULT_ESTIMATOR)
"""Baselines that are scored on several tracks, because all would take several times as long."""


@dataclass(frozen=True)
class Content:
    """Title and counts of a benchmarked corpus.

    ``classes`` counts records, ``unknown`` those left out because their class is not known.
    """

    title: str
    records: int
    recordings: int
    specimens: int
    rigs: int
    classes: dict[str, int]
    unknown: int = 0


@dataclass(frozen=True)
class Baseline:
    """Scores of one classifier: cross-validated on a track, of both controls, and on each of the other corpora.

    ``behind`` is how far its balanced accuracy lies below that of the best classifier of the track, and the 95 % interval of this
    difference over the same resampled specimens; None if a class has only one specimen. If 0 is in it, the two cannot be ranked.
    """

    grouped: Scores
    leaky: Scores
    null: Scores
    tests: tuple[Scores, ...]
    behind: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class TrackResults:
    """Scores on a further track, by name of the classifier.

    Attributes
    ----------
    folds
        Number of its splits.
    tested, records
        Numbers of records that are tested, and of all.
    baselines
        Scores by name of the classifier.
    """

    folds: int
    tested: int
    records: int
    baselines: dict[str, Baseline]


@dataclass(frozen=True, repr=False)
class Results(Shown):
    """Results of a benchmark, all of plain types.

    Attributes
    ----------
    corpus, tests
        The corpus, and the other corpora.
    track, folds
        Of the grouped cross-validation: the first track, and the number of its splits.
    seed
        Of splits, estimators, permutation and bootstrap.
    groups, features
        Groups and number of the features.
    versions
        Of the libraries.
    leading
        Name of the classifier that the findings are about: the best on the first track, an untrained one only without others.
    baselines
        Scores by name of the classifier.
    further
        Results on further tracks, by name of the track.
    left_out
        Reason for each track that the corpus cannot be split on, if all tracks were asked for.
    importance
        Permutation importance of each quantity for the leading classifier on the first track, the highest first: the loss
        of balanced accuracy when the values of its features are exchanged among tested records. Empty for waveforms.
    models
        Scores of models that were trained before, on all records of the corpus and then of each of the others, by name.
    submissions
        Scores of predictions in a file on the first track, by name of their column.
    """

    corpus: Content
    tests: tuple[Content, ...]
    track: str
    folds: int
    seed: int
    groups: tuple[str, ...]
    features: int
    versions: dict[str, str]
    leading: str
    baselines: dict[str, Baseline]
    further: dict[str, TrackResults] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)
    importance: dict[str, float] = field(default_factory=dict)
    models: dict[str, tuple[Scores, ...]] = field(default_factory=dict)
    submissions: dict[str, Scores] = field(default_factory=dict)

    def _heading(self) -> str:
        return f"Results on {self.corpus.title}: {self.corpus.records:,} records, balanced accuracy over {self.folds} folds by {self.track}"

    def _facts(self) -> Mapping[str, object]:
        return {
            name: ", ".join(
                [
                    f"{scores.grouped.balanced_accuracy:.3f} ({interval_text(scores.grouped.interval)})",
                    f"permuted labels {scores.null.balanced_accuracy:.3f}",
                    *(
                        f"{test.title} {of.balanced_accuracy:.3f}"
                        for test, of in zip(self.tests, scores.tests, strict=True)
                    ),
                ]
            )
            for name, scores in self.baselines.items()
        }


def benchmark(
    table: xr.Dataset,
    tests: xr.Dataset | Sequence[xr.Dataset] = (),
    *,
    tracks: Sequence[Track] | Literal["all"] = ("specimen",),
    estimators: Mapping[str, str | Maker] | None = None,
    waveforms: Sequence[Waveforms] = (),
    folds: int = 5,
    groups: Sequence[str] = DEFAULT_GROUPS,
    seed: int = 0,
    workers: int = 1,
    progress: Progress | None = None,
) -> Results:
    """Cross-validate classifiers with their controls, and test them on other corpora.

    Parameters
    ----------
    table
        Feature table of the corpus.
    tests
        Feature table of another corpus, or of several, such as recordings of real machines, without records of ``table``.
    tracks
        Respects in which the tested records are new; ``"all"`` omits those that the corpus cannot be split on.
    estimators
        Classifiers by the name to show, as for `cross_validate`. The untrained baselines are
        always scored too. By default all baselines, or those of `BRIEF` if there are several tracks.
    waveforms
        Waveforms of the corpus and of each of the others, in this order, for the classifiers of the user in place of the features.
    folds
        Number of splits.
    groups
        Groups of features.
    seed
        Of splits, estimators, permutation and bootstrap.
    workers
        Number of processes that score baselines; 1 is this one. The scores do not depend on it.
    progress
        Called after each score with the number of scores done and of all.

    Raises
    ------
    CorpusError
        If the table cannot be cross-validated (see ``cross_validate``), or shares records with one of ``tests``.
    EstimatorError
        If a classifier of the user fails.
    """
    tests = (tests,) if isinstance(tests, xr.Dataset) else tests
    # everything that can be refused is refused before the first fit
    names = features_of(table, groups)
    records = labelled_records(table, names)
    cases, left_out = _cases(records, tracks, folds, seed)
    others = [labelled_records(test, names) for test in tests]
    for other in others:
        _check_apart(records, other)
    chosen = _chosen(estimators, several=len(cases) > 1)
    first, splits = next(iter(cases)), next(iter(cases.values()))["grouped"][1]
    own = records_of(waveforms[0], groups) if waveforms else records
    # a job is one classifier on one track in one case: grouped, leaky, null or other corpora
    jobs = [
        (name, track, case)
        for name in chosen
        for track in cases
        for case in _CASES
        if _is_scored(case, track, first, tests)
    ]
    done, scores = counter(progress, len(jobs)), dict[_Job, Any]()
    # classifiers of the user stay in this process: they may not be sent to others
    for is_own, tested, tables in ((False, records, (table, *tests)), (True, own, waveforms or (table, *tests))):
        makers = {name: estimator for name, estimator in chosen.items() if isinstance(estimator, str) != is_own}
        some = [job for job in jobs if job[0] in makers]
        task = partial(_scores_of, tested, tables, cases, makers, groups, seed)
        for job, score_of_job in zip(
            some, run(task, some, 1 if is_own else max(1, min(workers, len(some)))), strict=True
        ):
            scores[job] = score_of_job
            done(1)

    def rows(track: str) -> dict[str, Baseline]:
        best = max(chosen, key=lambda name: scores[name, track, "grouped"][0].balanced_accuracy)
        return {
            name: Baseline(
                scores[name, track, "grouped"][0],
                scores[name, first, "leaky"][0],
                scores[name, track, "null"][0],
                scores.get((name, track, "tests"), ()),
                _behind(scores[best, track, "grouped"], scores[name, track, "grouped"]),
            )
            for name in chosen
        }

    baselines = rows(first)
    leading = max(chosen, key=lambda name: (name not in UNTRAINED, baselines[name].grouped.balanced_accuracy))
    led = isinstance(chosen[leading], str) or not waveforms
    return Results(
        corpus=_content(records, count_unknown(table)),
        tests=tuple(_content(other, count_unknown(test)) for other, test in zip(others, tests, strict=True)),
        track=first,
        folds=len(splits),
        seed=seed,
        groups=tuple(groups),
        features=len(names),
        versions={library: version(library) for library in ("raceway", "scikit-learn", "numpy", "scipy", "numba")},
        leading=leading,
        baselines=baselines,
        further={track: _further(records, cases[track], rows(track)) for track in list(cases)[1:]},
        left_out=left_out,
        importance=_importance(records, names, chosen[leading], splits, seed) if led else {},
    )


def leaky_text(baselines: Iterable[Baseline]) -> str:
    """Sentence on scores of the leaky split below those of the track; empty without one."""
    if not any(of.leaky.balanced_accuracy < of.grouped.balanced_accuracy for of in baselines):
        return ""
    return (
        "A leaky split that scores lower shows no leak: its folds are others, and a recognised specimen misleads if its other records "
        "are of other classes."
    )


_Job = tuple[str, str, str]
"""Names of a classifier, a track and a case."""


def _is_scored(case: str, track: str, first: str, tests: Sequence[object]) -> bool:
    """Whether a case has a score of its own on a track: the leaky split is the same on all of them, and other corpora have none."""
    return case in ("grouped", "null") or (track == first and (case == "leaky" or bool(tests)))


def _scores_of(
    records: Records,
    tables: Sequence[xr.Dataset | Waveforms],
    cases: Mapping[str, Mapping[str, Case]],
    estimators: Mapping[str, str | Maker],
    groups: Sequence[str],
    seed: int,
    job: _Job,
) -> tuple[Scores, FloatArray | None] | tuple[Scores, ...]:
    """Scores of one job, as of `score_splits` or on each of the other corpora; the first of the tables is that of the records."""
    name, track, case = job
    estimator = estimators[name]
    if case != "tests":
        return score_splits(records, *cases[track][case], estimator, seed)
    model = Model(estimator, groups=groups, seed=seed).fit(tables[0])
    return tuple(model.score(test, seed=seed) for test in tables[1:])


def _behind(
    best: tuple[Scores, FloatArray | None], other: tuple[Scores, FloatArray | None]
) -> tuple[float, float, float] | None:
    (leader, of_leader), (scores, resampled) = best, other
    if of_leader is None or resampled is None:
        return None
    return leader.balanced_accuracy - scores.balanced_accuracy, *ends_of(of_leader - resampled)


def _importance(
    records: Records, names: Sequence[str], estimator: str | Maker, splits: Sequence[Split], seed: int
) -> dict[str, float]:
    """Permutation importance of each quantity, the highest first; its features of all views and channels are exchanged at once."""
    columns: dict[str, list[int]] = {}
    for column in range(records.features.shape[1]):
        columns.setdefault(measured_quantity(names[column % len(names)]), []).append(column)
    losses = permutation_losses(records, list(columns.values()), estimator, splits, seed).mean(axis=0)
    return dict(sorted(zip(columns, losses.tolist(), strict=True), key=lambda item: -item[1]))


def _chosen(estimators: Mapping[str, str | Maker] | None, *, several: bool) -> dict[str, str | Maker]:
    """Classifiers to score by name, the untrained baselines first."""
    if estimators is None:
        return {name: name for name in (BRIEF if several else BASELINES)}
    return {name: name for name in UNTRAINED} | dict(estimators)


def _cases(
    records: Records, tracks: Sequence[Track] | Literal["all"], folds: int, seed: int
) -> tuple[dict[str, dict[str, Case]], dict[str, str]]:
    """Labels and splits by track and case: ``grouped``, ``leaky`` and ``null``; and tracks left out, with the reason."""
    cases: dict[str, dict[str, Case]] = {}
    left_out: dict[str, str] = {}
    for track in TRACKS if tracks == "all" else dict.fromkeys(tracks):
        try:
            grouped = grouped_case(records, track, folds, seed)
            cases[track] = {"grouped": grouped, **control_cases(records, track, folds, seed)}
        except CorpusError as error:
            if tracks != "all" or track == TRACKS[0]:
                raise
            left_out[track] = str(error)
    return cases, left_out


def _further(records: Records, cases: dict[str, Case], baselines: dict[str, Baseline]) -> TrackResults:
    _, splits = cases["grouped"]
    return TrackResults(len(splits), sum(len(test) for _, test in splits), len(records.fault), baselines)


def _check_apart(records: Records, test: Records) -> None:
    shared = seen_records(test.features.to_numpy(), record_digests(records.features.to_numpy()))
    if shared:
        raise CorpusError(
            f"{test.title}: {shared} of its records are in the training corpus too; "
            f"give a test corpus without training records."
        )


def _content(records: Records, unknown: int) -> Content:
    return Content(
        title=records.title,
        **unit_counts(records._asdict())._asdict(),
        classes=class_counts(records.fault),
        unknown=unknown,
    )
