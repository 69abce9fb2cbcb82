"""The command that measures the scores of all baselines on a corpus."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from features.baselines.names import BASELINES, DEFAULT_ESTIMATOR, TRACKS
from raceway.commands.model_commands import warn_of_durations, warn_of_seen
from raceway.console import show
from raceway.console.corpus_table import notice_of_unknown, table_of, tables_for
from raceway.console.options import (
    A_CORPUS,
    A_MODEL,
    REFERENCE_MODEL,
    Analysis,
    Team,
    corpus_argument,
    file_option,
    json_option,
    pages_option,
    speed_option,
    training_options,
    worker_options,
)
from raceway.console.progress_bar import progress, warn

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Baseline, Results, Scores
    from features.table.recording_speeds import Speed
    from features.table.waveforms import Waveforms


def _checked_names(_context: click.Context, _option: click.Parameter, names: tuple[str, ...]) -> tuple[str, ...]:
    for name in names:
        if name not in (*BASELINES, "all") and not all(name.partition(":")):
            raise click.BadParameter(f"{name!r} is none of {', '.join(BASELINES)}, all, or MODULE:NAME of your own")
    return names


@click.command()
@corpus_argument
@pages_option("OUTDIR", "Folder for report.html and results.json.", required=False)
@file_option(
    "FILE.csv",
    f"Write the predictions on the first track of each --estimator, or else of the {DEFAULT_ESTIMATOR}, which --check scores again, and "
    "nothing else.",
    (".csv",),
    required=False,
    flags=("--submit",),
)
@click.option(
    "--check",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE.csv",
    help="Score the predictions in a file of --submit again, alone or beside the baselines of -o.",
)
@click.option(
    "--test",
    "tests",
    type=A_CORPUS,
    multiple=True,
    metavar="DIR2",
    help="Another corpus to test on, such as real recordings. Repeatable.",
)
@click.option(
    "--track",
    "tracks",
    type=click.Choice([*TRACKS, "all"]),
    multiple=True,
    default=["specimen"],
    show_default=True,
    metavar="NAME",
    help=f"Respect in which tested records are new: {', '.join(TRACKS)}, or all. Repeatable.",
)
@click.option(
    "--estimator",
    "estimators",
    multiple=True,
    metavar="NAME",
    callback=_checked_names,
    help="Classifier to score: a baseline, all of them (all), or MODULE:NAME of your own. Repeatable.",
)
@click.option(
    "--model",
    "models",
    type=A_MODEL,
    multiple=True,
    metavar="MODEL",
    help="Also score a trained model on DIR and each DIR2: a file of raceway train, or reference, the model of raceway diagnose. "
    "Repeatable.",
)
@click.option(
    "--waveforms", is_flag=True, help="Give your own classifiers the signals, shape (record, time), and no features."
)
@click.option(
    "--per-turn",
    type=click.IntRange(1, 16_384),
    metavar="N",
    help="Resample these signals to N samples per turn of the shaft.",
)
@click.option(
    "--folds", type=click.IntRange(min=2), metavar="K", default=5, show_default=True, help="Number of splits."
)
@click.option(
    "--seed", type=int, default=0, show_default=True, metavar="S", help="Seed of splits, classifiers and bootstrap."
)
@training_options
@speed_option
@worker_options
@json_option
def benchmark(
    corpus: Path,
    output: Path | None,
    submit: Path | None,
    check: Path | None,
    tests: tuple[Path, ...],
    tracks: tuple[Any, ...],
    estimators: tuple[str, ...],
    models: tuple[Path | None, ...],
    waveforms: bool,
    per_turn: int | None,
    folds: int,
    seed: int,
    analysis: Analysis,
    speed: "Speed",
    team: Team,
    as_json: bool,
) -> None:
    """Measure the scores of all baselines on DIR.

    Cross-validation keeps all records of a specimen on one side of each split, and all of a rig, bearing
    type or speed range with --track. Two controls are shown beside each score: a split of random records,
    which leaks, and labels permuted among specimens, which must score near chance. With --test, models trained on all of DIR are also
    scored on DIR2; --speed concerns DIR2 alone, --channel DIR alone (of DIR2 the first channel is taken).

    MODULE:NAME is an estimator as of scikit-learn, or a class or function that makes one; its code is run. MODULE is a file of the
    current folder or an installed module. With --estimator or several tracks, the other trained baselines are left out.

      raceway benchmark corpus -o report
      raceway benchmark corpus --test cwru --test mfpt -o report --track rig
      raceway benchmark corpus --test cwru -o report --model reference
      raceway benchmark corpus -o report --track all
      raceway benchmark corpus -o report --estimator mine:make --estimator ensemble
      raceway benchmark corpus --test cwru -o report --waveforms --estimator cnn:Classifier
      raceway benchmark corpus --track rig --folds 3 --estimator mine:make --submit mine.csv
      raceway benchmark corpus --track rig --folds 3 --check mine.csv -o report
    """
    # options that need another one are refused before anything is loaded
    if waveforms and not any(":" in name for name in estimators):
        raise click.UsageError("--waveforms is for --estimator MODULE:NAME")
    if per_turn is not None and not waveforms:
        raise click.UsageError("--per-turn is for --waveforms")
    if (submit is None) == (output is None and check is None):
        raise click.UsageError("give -o OUTDIR, --check FILE.csv or both, or --submit FILE.csv")
    if (analysis.groups or tests or models) and output is None:
        raise click.UsageError("--group, --test and --model are for -o OUTDIR")
    from features.baselines import DEFAULT_GROUPS, check_submission, load_maker, unseeded, write_submission
    from features.baselines import benchmark as run
    from gen.corpus import result_folder
    from raceway.kept_models import open_model
    from raceway.reports.report_page import write_report

    spelled = dict.fromkeys(baseline for name in estimators for baseline in (BASELINES if name == "all" else (name,)))
    chosen = {name: load_maker(name) if ":" in name else name for name in spelled}
    for name, maker in chosen.items():
        if not isinstance(maker, str) and (parameters := unseeded(maker, seed)):
            warn(
                f"{name}: {', '.join(parameters)} is None, so its scores may change from call to call; set it, or give "
                "the function that makes the classifier an argument seed."
            )
    protocol: Any = {"track": next(iter(TRACKS)) if "all" in tracks else tracks[0], "folds": folds, "seed": seed}
    # the check of a submission, or a submission, in place of a report
    if check is not None and output is None:
        scores = check_submission(table_of(corpus, "off", team, analysis), check, **protocol)
        if as_json:
            show.as_json({name: show.plain(of) for name, of in scores.items()})
        else:
            _show_submissions(scores)
        return
    if submit is not None:
        chosen = chosen or {DEFAULT_ESTIMATOR: DEFAULT_ESTIMATOR}
        signals = _waveforms(corpus, analysis.channel, [], per_turn)[0] if waveforms else None
        write_submission(table_of(corpus, "off", team, analysis), chosen, submit, waveforms=signals, **protocol)
        show.text(f"{submit}: predictions of {', '.join(chosen)}; --check scores them again.")
        return
    assert output is not None  # noqa: S101 - neither of the others is given alone
    # a wrong model file is told before the features are computed
    loaded = {
        f"./{path}" if path == Path(REFERENCE_MODEL) else str(path or REFERENCE_MODEL): open_model(path)[0]
        for path in dict.fromkeys(models)
    }
    with result_folder(output):
        groups = analysis.with_groups(DEFAULT_GROUPS)
        table = table_of(corpus, "off", team, analysis)
        submitted = {} if check is None else check_submission(table, check, **protocol)
        # speeds are checked or corrected on other corpora, whose labels may be wrong
        others = [table_of(test, speed, team, analysis._replace(channel=None)) for test in tests]
        scored = {}
        # each trained model has a band and a duration of its own
        for name, model in loaded.items():
            tested = tables_for(model, [corpus], "off", team, analysis.channel)
            tested += [of for test in tests for of in tables_for(model, [test], speed, team)]
            scored[name] = tuple(model.score(of, seed=seed) for of in tested)
            for of, scores in zip(tested, scored[name], strict=True):
                warn_of_seen(name, scores)
                warn_of_durations(name, model, of)
        options = {
            "tracks": "all" if "all" in tracks else tracks,
            "estimators": chosen or None,
            "waveforms": _waveforms(corpus, analysis.channel, list(zip(tests, others, strict=True)), per_turn)
            if waveforms
            else [],
            "workers": team.options(table.sizes["record"])["workers"],
            "groups": groups,
        }
        with progress("scoring", "scores") as report:
            results = run(table, others, **options, folds=folds, seed=seed, progress=report)
        results = replace(results, models=scored, submissions=submitted)
        # records that no score counts
        for path, content in zip((corpus, *tests), (results.corpus, *results.tests), strict=True):
            notice_of_unknown(path, content.unknown)
        page = write_report(corpus, results, output)
    if as_json:
        show.as_json({"report": page, "results": output / "results.json", **show.plain(results)})
        return
    _show(results, [test.name for test in tests])
    show.text("", f"{page}: the complete report.")


def _show(results: "Results", tests: list[str]) -> None:
    """Show the scores on each track and on other corpora, and those of trained models."""
    from features.baselines import leaky_text, no_width_text

    show.text(f"Balanced accuracy on {results.corpus.title}, {results.folds} folds by {results.track}:", "")
    _show_baselines(results.baselines, tests)
    if results.submissions:
        show.text("")
        _show_submissions(results.submissions)
    if results.models:
        show.text("")
        rows = ((name, *(f"{of.balanced_accuracy:.3f}" for of in scores)) for name, scores in results.models.items())
        show.table(("trained model", "all records", *tests), rows)
    for track, of_track in results.further.items():
        about = f"By {track}, {of_track.folds} folds, {of_track.tested:,} of {of_track.records:,} records tested:"
        show.text("", about, "")
        _show_baselines(of_track.baselines, [])
    for track, reason in results.left_out.items():
        show.text("", f"No scores by {track}. {reason}")
    # what figures above may be misread for
    baselines = [baseline for of in (results, *results.further.values()) for baseline in of.baselines.values()]
    scored = [*(baseline.grouped for baseline in baselines), *results.submissions.values()]
    for sentence in filter(None, (no_width_text(scored), leaky_text(baselines))):
        show.text("", sentence)


def _show_baselines(baselines: "Mapping[str, Baseline]", tests: list[str]) -> None:
    from features.baselines import behind_text

    rows = []
    for name, baseline in baselines.items():
        further = (baseline.leaky, baseline.null, *baseline.tests)
        score, interval, alarms = _figures(baseline.grouped)
        controls = (f"{scores.balanced_accuracy:.3f}" for scores in further)
        rows.append((name, score, interval, behind_text(baseline.behind), alarms, *controls))
    show.table(
        ("baseline", "score", "95 %", "below the best", "false alarms", "leaky split", "null labels", *tests), rows
    )


def _show_submissions(submitted: "Mapping[str, Scores]") -> None:
    rows = ((name, *_figures(scores)) for name, scores in submitted.items())
    show.table(("submitted", "score", "95 %", "false alarms"), rows)


def _figures(scores: "Scores") -> list[str]:
    """Balanced accuracy, its interval, and share of false alarms."""
    from features.baselines import interval_text

    alarms = "" if scores.false_alarms is None else f"{scores.false_alarms:.3f}"
    return [f"{scores.balanced_accuracy:.3f}", interval_text(scores.interval, 2), alarms]


def _waveforms(
    corpus: Path, channel: Any, tests: "list[tuple[Path, xr.Dataset]]", per_turn: int | None
) -> "list[Waveforms]":
    """Waveforms of the corpus and of the other corpora, resampled to the same number of turns, at the speeds of their tables."""
    from features import open_waveforms
    from features.table.recording_speeds import rates_to_use

    signals = [open_waveforms(corpus, channel=channel or 0, normalise=True, per_turn=per_turn)]
    turns = None if per_turn is None else signals[0].samples // per_turn
    for path, table in tests:
        rates = rates_to_use(table)
        signals.append(open_waveforms(path, normalise=True, shaft_rate=rates, per_turn=per_turn, turns=turns))
    return signals
