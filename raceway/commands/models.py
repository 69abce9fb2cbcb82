"""Commands that train a model and score it on another corpus."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.commands.feature_tables import notice_of_unknown, table_of
from raceway.console import show
from raceway.console.options import A_PATH, corpus_argument, file_option, json_option
from raceway.console.progress import notice

if TYPE_CHECKING:
    from features.baselines import Results, Scores

# a copy of the names, since help must not import the registry; a test compares the two
ESTIMATORS = (
    "majority",
    "envelope_rule",
    "logistic_regression",
    "svm",
    "random_forest",
    "extra_trees",
    "gradient_boosting",
    "ensemble",
)


@click.command()
@corpus_argument
@file_option("MODEL", "Model file.")
@click.option(
    "--estimator",
    type=click.Choice(ESTIMATORS),
    default="ensemble",
    show_default=True,
    metavar="NAME",
    help=f"One of {', '.join(ESTIMATORS)}.",
)
@json_option
def train(corpus: Path, output: Path, estimator: str, as_json: bool) -> None:
    """Train a classifier on the corpus in DIR.

    If the corpus has a test split (raceway info DIR), the model is trained on the other records and scored on the test split, which has
    other specimens. Otherwise it is trained on all records and not scored. Model files run no code when they are loaded.

      raceway train corpus -o model.skops
      raceway train corpus -o forest.skops --estimator random_forest

    Next: raceway evaluate OTHER --model MODEL
    """
    from features.baselines import count_unknown, save_model
    from features.baselines import evaluate as score
    from features.baselines import train as fit
    from gen.corpus import SPLITS

    table = table_of(corpus)
    notice_of_unknown(corpus, count_unknown(table))
    test = table["split"].values == SPLITS.index("test")
    honest = bool(test.any() and not test.all())
    model = fit(table.isel(record=~test) if honest else table, estimator)
    save_model(model, output)
    scores = score(table.isel(record=test), model) if honest else None
    warn_of_severities(scores)
    if as_json:
        names = ("records", "classes", "groups")
        facts = {name: getattr(model, name) for name in names}
        show.as_json(
            {"model": output, "estimator": estimator, **facts, "features": len(model.features), "test": scores}
        )
        return
    show.text(
        f"{output}: {estimator}, trained on {show.counted(model.records, 'record')}, classes {', '.join(model.classes)}."
    )
    if scores is not None:
        show.text("", f"Scores on the test split of {show.counted(scores.records, 'record')}:")
        _show_scores(scores)


@click.command()
@corpus_argument
@click.option("--model", type=A_PATH, required=True, metavar="MODEL", help="Model file written by raceway train.")
@json_option
def evaluate(corpus: Path, model: Path, as_json: bool) -> None:
    """Score a model on every record of the corpus in DIR.

    Scores cover the classes present in DIR; predicting a class absent from DIR counts as wrong. Records cut from one recording are also
    scored together, by the sum of their probabilities. The interval is a bootstrap over specimens.

      raceway evaluate cwru --model model.skops
    """
    from features.baselines import count_unknown, load_model
    from features.baselines import evaluate as score

    loaded = load_model(model)
    table = table_of(corpus)
    notice_of_unknown(corpus, count_unknown(table))
    scores = score(table, loaded)
    warn_of_severities(scores)
    if scores.seen:
        notice(
            f"warning: the model was trained on {scores.seen:,} of these {scores.records:,} records; this is no fair test."
        )
    if as_json:
        show.as_json({"corpus": corpus, "model": model, "estimator": loaded.name, **show.plain(scores)})
        return
    show.text(f"{loaded.name} trained on {loaded.corpus}, tested on {corpus}:", "")
    _show_scores(scores)


def warn_of_severities(*tested: "Scores | Results | None") -> None:
    """Warn of fault widths that were tested and not trained."""
    from features.baselines import severity_warning

    for found in tested:
        if found is not None and found.uncovered_widths:
            notice(f"warning: {severity_warning(found.uncovered_widths)}")


def _show_scores(scores: "Scores") -> None:
    from features.baselines import interval_text

    found = {
        "balanced accuracy": f"{scores.balanced_accuracy:.3f} (95 % interval {interval_text(scores.interval)})",
        "macro F1": f"{scores.macro_f1:.3f}",
        "accuracy": f"{scores.accuracy:.3f}",
        "records": f"{scores.records:,}",
    }
    whole = scores.by_recording
    if whole is not None and whole.records < scores.records:
        found["by recording"] = f"balanced accuracy {whole.balanced_accuracy:.3f} of {whole.records:,}"
    show.facts(found)
    show.text("")
    show.table(
        ("true \\ predicted", *scores.model_classes),
        zip(scores.classes, *zip(*scores.confusion, strict=True), strict=True),
    )
