"""Commands that train a model and score it on another corpus."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from features.baselines.names import BASELINES, DEFAULT_ESTIMATOR
from raceway.console import show
from raceway.console.corpus_table import notice_of_unknown, table_of, tables_for
from raceway.console.options import (
    A_CORPUS,
    Analysis,
    Team,
    channels_option,
    corpus_argument,
    file_option,
    json_option,
    model_option,
    speed_option,
    training_options,
    worker_options,
)
from raceway.console.progress_bar import warn

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Calibration, Model, Scores
    from features.table.recording_speeds import Speed


class _Baseline(click.Choice[str]):
    """A baseline; the refusal of others says where they are taken."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        if ":" in value:
            self.fail(
                f"{value!r} is no baseline; raceway benchmark takes your own, and so does features.Model.", param, ctx
            )
        return super().convert(value, param, ctx)


@click.command()
@corpus_argument
@file_option("MODEL", "Model file: .skops.", (".skops",), kind="model")
@click.option(
    "--estimator",
    type=_Baseline(BASELINES),
    default=DEFAULT_ESTIMATOR,
    show_default=True,
    metavar="NAME",
    help=f"One of {', '.join(BASELINES)}.",
)
@training_options
@worker_options
@json_option
def train(
    corpus: Path,
    output: Path,
    estimator: str,
    analysis: Analysis,
    team: Team,
    as_json: bool,
) -> None:
    """Train a classifier on the corpus in DIR.

    If the corpus has a test split (raceway info DIR), the model is trained on the other records and scored on the test split, which has
    other specimens. Otherwise, or if all records are test records, as imported ones are, it is trained on all of them and not scored;
    raceway benchmark scores by specimen or rig. Model files run no code when they are loaded.

      raceway train corpus -o model.skops
      raceway train corpus -o forest.skops --estimator random_forest
      raceway train corpus -o high.skops --channel fan_end --band 300 9000

    The model keeps the band, and raceway evaluate computes features from the same one.

    --workers and --scheduler compute the features. The workers also train; the model is the same.

    Next: raceway evaluate OTHER --model MODEL
    """
    from features.baselines import count_unknown
    from raceway.kept_models import train_and_score

    table = table_of(corpus, "off", team, analysis)
    notice_of_unknown(corpus, count_unknown(table))
    model, scores = train_and_score(table, estimator, team, analysis)
    model.save(output)
    if as_json:
        names = ("records", "classes", "groups")
        facts = {name: getattr(model, name) for name in names} | {"calibration": model.calibration._asdict()}
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
@click.option(
    "--reference",
    type=A_CORPUS,
    metavar="DIR",
    help="Corpus with healthy records of the same rigs, which may be the tested one.",
)
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
) -> None:
    """Score a model on every record of the corpus in DIR.

    Records longer than those of the training are cut into windows, whose mean features are classified, as raceway diagnose does.

    Scores cover the classes present in DIR; predicting a class absent from DIR counts as wrong. Records cut from one recording are also
    scored together, by the mean of their features. The interval is a bootstrap over specimens. A record is answered if
    its largest probability reaches the threshold of the model, and otherwise the answer is "unsure". Recordings of class unknown are not
    scored: raceway diagnose answers for recordings.

    With --reference, records are compared with healthy records of their rig: those of another corpus, or of the tested one itself. Records
    of the reference are left out of the scores. A "healthy" is answered only if the spectral colour is near that of the reference.

      raceway evaluate cwru                           with the reference model of raceway diagnose
      raceway evaluate cwru --model model.skops
      raceway evaluate pump --model model.skops --channel x,y,z
      raceway evaluate pump --model model.skops --reference pump
    """
    from features.baselines import count_unknown
    from features.baselines.classifying import check_takes_reference, suited_to
    from features.baselines.reference_choice import check_durations
    from gen import open_corpus
    from raceway.kept_models import open_model

    # a wrong path is told before a model is trained and features are computed
    if model is None:
        open_corpus(corpus).close()
    if reference is not None:
        check_durations(corpus, reference)
    loaded, source = open_model(model)
    corpora = [path for path in dict.fromkeys((corpus, reference)) if path is not None]
    # before the features are computed
    if reference is not None:
        check_takes_reference(suited_to(loaded, *corpora), str(reference))
    tables = tables_for(loaded, corpora, speed, team, channel)
    table = tables[0]
    # the reference is the tested corpus itself, or the second one
    scores = loaded.score(table, reference=None if reference is None else tables[-1])
    unknown = count_unknown(table)
    notice_of_unknown(corpus, unknown)
    warn_of_seen("the model", scores)
    warn_of_durations("the model", loaded, table)
    if as_json:
        about = {"corpus": corpus, "model": source, "estimator": loaded.name, "unknown": unknown}
        show.as_json(about | show.plain(scores))
        return
    show.text(f"{loaded.name} trained on {loaded.corpus}, tested on {corpus}:", "")
    if scores.reference:
        show.text(scores.reference, "")
    _show_scores(scores)


def calibration_text(calibration: "Calibration") -> str:
    """Sentence on the calibration of a model."""
    if calibration.by == "nothing":
        return "Not calibrated: every record is answered."
    from features.baselines import percent_text

    least = f"at least {percent_text(calibration.threshold)}".replace("at least >", "more than")
    return (
        f"Calibrated on {calibration.by}s outside the training: answers {100 * calibration.coverage:.0f} % of their records, those with "
        f"a largest probability of {least}, and is unsure of the others."
    )


def warn_of_seen(model: str, scores: "Scores") -> None:
    """Warn of tested records that the model was trained on."""
    if scores.seen:
        warn(f"{model} was trained on {scores.seen:,} of these {scores.records:,} records; this is no fair test.")


def warn_of_durations(name: str, model: "Model", table: "xr.Dataset") -> None:
    """Warn of records of another duration than those of the training, or of longer ones in a table that was not made for the model."""
    from features.baselines.classifying import SAME_DURATION, suited
    from features.table.band import band_of
    from features.table.durations import durations_of

    tested = durations_of(table)
    trained = suited(model, tested, band_of(table.attrs).high).durations
    spans = ((model.shorter.durations,) if model.shorter else ()) + (model.durations,)
    if tested and trained and not trained[0] / SAME_DURATION < tested[0] <= tested[1] < trained[1] * SAME_DURATION:
        warn(
            f"the records last {_span(tested)} s, and those that {name} was trained on {' or '.join(map(_span, spans))} s; lines "
            "rise higher above the floor in longer records. Use records of such a duration."
        )


def _span(durations: tuple[float, ...]) -> str:
    return " to ".join(dict.fromkeys(f"{duration:.3g}" for duration in durations))


def _show_scores(scores: "Scores") -> None:
    from features.baselines import no_width_text

    whole = scores.by_recording
    compared = [scores] if whole is None or whole.records == scores.records else [scores, whole]
    header = ("", "by record", "by recording")[: 1 + len(compared)]
    show.table(header, zip(FIGURES, *(_figures(scored) for scored in compared), strict=True))
    show.text("", "Records by their most probable class, those that are not answered too:")
    show.table(
        ("true \\ predicted", *scores.model_classes),
        zip(scores.classes, *zip(*scores.confusion, strict=True), strict=True),
    )
    # what the tables do not tell
    untested = [name for name in scores.model_classes if name not in scores.classes]
    absent = (
        f"No tested record is of class {' or '.join(untested)}, of which the scores tell nothing." if untested else ""
    )
    for sentence in filter(None, (no_width_text(compared), absent)):
        show.text("", sentence)


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
    'faulty among answered "healthy"',
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
    """Figure, or that there are no records to tell it."""
    return "not known" if figure is None else f"{figure:.3f}"
