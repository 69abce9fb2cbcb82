"""Commands that train a model and score it on another corpus."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from features.baselines.names import BASELINES, DEFAULT_ESTIMATOR
from raceway.commands.reference_options import reference_options, reference_table
from raceway.console import show
from raceway.console.corpus_table import notice_of_unknown, table_of
from raceway.console.options import (
    USUAL_ANALYSIS,
    Analysis,
    Team,
    analysis_options,
    channels_option,
    complete_recipes,
    corpus_argument,
    corpus_path,
    file_option,
    json_option,
    model_option,
    speed_option,
    worker_options,
)
from raceway.console.progress_bar import notice

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Answer, Calibration, Model, Results, Scores
    from features.table.recording_speeds import Speed


@click.command()
@click.argument("source", metavar="DIR|RECIPE", shell_complete=complete_recipes)
@file_option(
    "MODEL", "Model file; without it the model of a RECIPE is kept for this user.", kind="model", required=False
)
@click.option(
    "--estimator",
    type=click.Choice(BASELINES),
    default=DEFAULT_ESTIMATOR,
    show_default=True,
    metavar="NAME",
    help=f"One of {', '.join(BASELINES)}.",
)
@analysis_options
@worker_options
@json_option
def train(
    source: str,
    output: Path | None,
    estimator: str,
    analysis: Analysis,
    team: Team,
    as_json: bool,
) -> None:
    """Train a classifier on the corpus in DIR or of RECIPE.

    If the corpus has a test split (raceway info DIR), the model is trained on the other records and scored on the test split, which has
    other specimens. Otherwise it is trained on all records and not scored. Model files run no code when they are loaded.

      raceway train corpus -o model.skops
      raceway train corpus -o forest.skops --estimator random_forest
      raceway train corpus -o high.skops --channel fan_end --band 300 9000
      raceway train domain_randomised                 the reference model of raceway diagnose
      raceway train my_recipe.yaml -o model.skops

    A folder comes before a recipe of the same name. The corpus of a RECIPE is removed after the training; for domain_randomised the
    features of its records ship with Raceway. Without -o the model is kept in
    the folder RACEWAY_CACHE, or else in raceway in the cache folder of the user (XDG_CACHE_HOME or ~/.cache), and is not trained twice.

    The model keeps the band, and raceway evaluate computes features from the same one.

    --workers and --scheduler compute the features. The workers also train; the model is the same.

    Next: raceway evaluate OTHER --model MODEL
    """
    from features.baselines import count_unknown
    from raceway.kept_models import kept_model, recipe_tables, train_and_score

    folder = Path(source)
    from_folder = folder.is_dir() or (folder.is_file() and folder.suffix not in (".yaml", ".yml"))
    corpus = corpus_path(folder) if from_folder else None
    if corpus is None:
        if team.scheduler is not None:
            raise click.UsageError("--scheduler is for DIR: generate the corpus of the RECIPE with it first")
        from gen.recipe import find_recipe

        find_recipe(source)  # a misspelt name is reported before the simulator is imported
    if corpus is None and analysis != USUAL_ANALYSIS:
        raise click.UsageError("--channel and --band are for DIR: generate the corpus of the RECIPE first")
    if corpus is None and output is None:
        model, output, scores = kept_model(source, estimator, team=team)
    elif output is None:
        raise click.UsageError("Missing option '-o' / '--output': only the model of a RECIPE is kept without it.")
    else:
        tables = recipe_tables(source, team) if corpus is None else [table_of(corpus, "off", team, analysis)]
        notice_of_unknown(corpus or folder, count_unknown(tables[0]))
        model, scores = train_and_score(tables, estimator, team)
        model.save(output)
    warn_of_severities(scores)
    if as_json:
        names = ("records", "classes", "groups")
        facts = {name: getattr(model, name) for name in names} | {"calibration": model.calibration.model_dump()}
        facts |= {"takes_reference": model.relative is not None}
        show.as_json(
            {"model": output, "estimator": estimator, **facts, "features": len(model.features), "test": scores}
        )
        return
    show.text(
        f"{output}: {estimator}, trained on {show.count_text(model.records, 'record')}, classes {', '.join(model.classes)}.",
        calibration_text(model.calibration),
        "It also takes healthy records of the tested rig (raceway evaluate --reference)."
        if model.relative
        else "It takes no healthy reference: each class needs records on rigs with two healthy recordings.",
    )
    if scores is not None:
        show.text("", f"Scores on the test split of {show.count_text(scores.records, 'record')}:")
        _show_scores(scores)


@click.command()
@corpus_argument
@model_option
@channels_option
@reference_options
@speed_option
@worker_options
@json_option
def evaluate(
    corpus: Path,
    model: Path | None,
    channel: tuple[str, ...] | None,
    reference: Path | None,
    speed: "Speed",
    team: Team,
    as_json: bool,
    **reading: Any,
) -> None:
    """Score a model on every record of the corpus in DIR.

    Scores cover the classes present in DIR; predicting a class absent from DIR counts as wrong. Records cut from one recording are also
    scored together, by the mean of their features. The interval is a bootstrap over specimens. A record is answered if
    its largest probability reaches the threshold of the model, and otherwise the answer is "unsure". Recordings of class unknown are not
    scored; the answer for each of them is listed. --json also has verdicts: the number of recordings by true class and verdict, which
    are those of raceway diagnose at the speeds of DIR.

    With --reference, records are compared with healthy records of their rig: those of a corpus, which may be DIR itself, or a recording
    (.csv, .npy, .mat, .wav, ...) of the bearing of DIR. Records of the reference are left out of the scores. A "healthy" is answered only
    if the spectral colour is near that of the reference.

      raceway evaluate cwru                           with the reference model of raceway diagnose
      raceway evaluate cwru --model model.skops
      raceway evaluate pump --model model.skops --channel x,y,z
      raceway evaluate pump --model model.skops --reference pump
      raceway evaluate pump --model model.skops --reference new.csv --reference-rate 12000 --reference-rpm 1480
    """
    from features.baselines import Model, count_unknown, unlabelled_answers
    from gen import open_corpus
    from raceway.diagnosis import count_verdicts
    from raceway.kept_models import load_reference_model

    given = [name for name, value in reading.items() if value is not None]
    if reference is None and given:
        raise click.UsageError(f"--{given[0].replace('_', '-')} is for --reference")
    if model is None:
        open_corpus(corpus).close()  # a wrong path is told before the model is trained
    loaded, source = load_reference_model() if model is None else (Model.load(model), model)
    analysis = Analysis(channel, loaded.band)
    table = table_of(corpus, speed, team, analysis)
    healthy = None if reference is None else reference_table(reference, corpus, table, speed, team, analysis, reading)
    answers = unlabelled_answers(table, loaded, healthy)
    if count_unknown(table) == table.sizes["record"]:
        _show_answers_alone(corpus, source, loaded.name, answers, as_json=as_json)
        return
    scores = loaded.score(table, reference=healthy)
    warn_of_severities(scores)
    warn_of_seen("the model", scores)
    warn_of_durations("the model", loaded, table)
    if as_json:
        facts = {"corpus": corpus, "model": source, "estimator": loaded.name, **show.plain(scores)}
        show.as_json(
            facts | {"verdicts": count_verdicts(corpus, table, loaded, healthy), "unknown": show.plain(answers)}
        )
        return
    show.text(f"{loaded.name} trained on {loaded.corpus}, tested on {corpus}:", "")
    if scores.reference:
        show.text(scores.reference, "")
    _show_scores(scores)
    if answers:
        show.text("")
        _show_answers(answers)


def _show_answers_alone(
    corpus: Path, model: Path, estimator: str, answers: "Sequence[Answer]", *, as_json: bool
) -> None:
    """Show the answers for a corpus without any known class."""
    if as_json:
        show.as_json({"corpus": corpus, "model": model, "estimator": estimator, "unknown": show.plain(answers)})
        return
    show.text(f"{corpus}: no record has a known class, so there is no score.", "")
    _show_answers(answers)


def _show_answers(answers: "Sequence[Answer]") -> None:
    classes = tuple(answers[0].probabilities)
    show.table(
        ("class unknown", "records", "answer", *classes),
        (
            (one.source, f"{one.records}", one.answer, *(f"{p:.2f}" for p in one.probabilities.values()))
            for one in answers
        ),
    )


def calibration_text(calibration: "Calibration") -> str:
    """Sentence on the calibration of a model."""
    if calibration.by == "nothing":
        return "Not calibrated: every record is answered."
    return (
        f"Calibrated on {calibration.by}s outside the training: answers {100 * calibration.coverage:.0f} % of their records, those with "
        f"a largest probability of at least {calibration.threshold:.2f}, and is unsure of the others."
    )


def warn_of_seen(model: str, scores: "Scores") -> None:
    """Warn of tested records that the model was trained on."""
    if scores.seen:
        notice(
            f"warning: {model} was trained on {scores.seen:,} of these {scores.records:,} records; this is no fair test."
        )


def warn_of_durations(name: str, model: "Model", table: "xr.Dataset") -> None:
    """Warn of records that are shorter or longer than those of the training."""
    from features.table.durations import SAME_DURATION, durations_of, suited

    tested = durations_of(table)
    trained = suited(model, tested).durations
    known = ((model.shorter.durations,) if model.shorter else ()) + (model.durations,)
    if tested and trained and not trained[0] / SAME_DURATION < tested[0] <= tested[1] < trained[1] * SAME_DURATION:
        notice(
            f"warning: the records last {_span(tested)} s, and those that {name} was trained on {' or '.join(map(_span, known))} s; lines "
            "rise higher above the floor in longer records. Use records of such a duration."
        )


def _span(durations: tuple[float, ...]) -> str:
    return " to ".join(dict.fromkeys(f"{one:.3g}" for one in durations))


def warn_of_severities(*tested: "Scores | Results | None") -> None:
    """Warn of fault widths that were tested and not trained."""
    from features.baselines import severity_warning

    for scores in tested:
        if scores is not None and scores.uncovered_widths:
            notice(f"warning: {severity_warning(scores.uncovered_widths)}")


def _show_scores(scores: "Scores") -> None:
    whole = scores.by_recording
    compared = [scores] if whole is None or whole.records == scores.records else [scores, whole]
    header = ("", "by record", "by recording")[: 1 + len(compared)]
    show.table(header, zip(FIGURES, *(_figures(one) for one in compared), strict=True))
    show.text("")
    show.table(
        ("true \\ predicted", *scores.model_classes),
        zip(scores.classes, *zip(*scores.confusion, strict=True), strict=True),
    )


FIGURES = (
    "balanced accuracy",
    "95 % interval",
    "false alarms on healthy",
    "macro F1",
    "accuracy",
    "AUC",
    "log-loss",
    "calibration error",
    "answered",
    "accuracy of the answered",
    'faulty among "healthy"',
    "number",
)


def _figures(scores: "Scores") -> tuple[str, ...]:
    """Text of each of ``FIGURES``."""
    from features.baselines import interval_text

    return (
        f"{scores.balanced_accuracy:.3f}",
        interval_text(scores.interval),
        _shown(scores.false_alarms),
        f"{scores.macro_f1:.3f}",
        f"{scores.accuracy:.3f}",
        _shown(scores.auc),
        f"{scores.log_loss:.3f}",
        f"{scores.ece:.3f}",
        f"{scores.coverage:.3f}",
        _shown(scores.answered_accuracy),
        _shown(scores.faulty_among_healthy),
        f"{scores.records:,}",
    )


def _shown(figure: float | None) -> str:
    return "none" if figure is None else f"{figure:.3f}"
