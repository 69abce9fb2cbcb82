"""Commands from a corpus to pictures, features, models, scores and speed."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show
from raceway.console.options import (
    A_PATH,
    corpus_argument,
    corpus_folder,
    file_option,
    folder_option,
    json_option,
    recipe_argument,
    record_option,
)
from raceway.console.progress import compilation_noticed, notice, progress

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Baseline, Results, Scores

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
@record_option
@file_option("FILE", "Picture: .png, .svg or .pdf.", (".png", ".svg", ".pdf"))
def plot(corpus: Path, record: int, output: Path) -> None:
    """Draw one record with its fault lines.

    The picture has the waveform, the power spectrum and the envelope spectrum.

      raceway plot corpus --record 17 -o record.png
    """
    from features.report.examples import plot_record

    plot_record(corpus, record, output)
    show.text(f"{output}: record {record} of {corpus}.")


@click.command()
@corpus_argument
@file_option("FILE", "Feature table: .nc or .parquet.", (".nc", ".parquet"))
@json_option
def features(corpus: Path, output: Path, as_json: bool) -> None:
    """Compute the features of every record of DIR.

    The table has one row per record, with the features of its signal and all its labels.

      raceway features corpus -o features.nc
      raceway features corpus -o features.parquet
    """
    from features.table_files import check_destination, write_table

    check_destination(output)
    table = _table(corpus)
    write_table(table, output)
    records, columns = table.sizes["record"], table.sizes["feature"]
    missing = table.attrs["records_with_missing_features"]
    if as_json:
        facts = {"table": output, "records": records, "features": columns, "records_with_missing_features": missing}
        show.as_json(facts)
        return
    lacking = f"; some are missing in {show.counted(missing, 'record')}" if missing else ""
    show.text(f"{output}: {columns} features of {show.counted(records, 'record')}{lacking}.")


def _table(corpus: Path) -> "xr.Dataset":
    from features import feature_table

    with progress("computing features", "parts") as report:
        return feature_table(corpus, scheduler="local", progress=report)


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
    from features.baselines import evaluate as score
    from features.baselines import save_model
    from features.baselines import train as fit
    from gen.corpus import SPLITS

    table = _table(corpus)
    test = table["split"].values == SPLITS.index("test")
    honest = bool(test.any() and not test.all())
    model = fit(table.isel(record=~test) if honest else table, estimator)
    save_model(model, output)
    scores = score(table.isel(record=test), model) if honest else None
    _warn_of_severities(scores)
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
    from features.baselines import evaluate as score
    from features.baselines import load_model

    loaded = load_model(model)
    scores = score(_table(corpus), loaded)
    _warn_of_severities(scores)
    if scores.seen:
        notice(
            f"warning: the model was trained on {scores.seen:,} of these {scores.records:,} records; this is no fair test."
        )
    if as_json:
        show.as_json({"corpus": corpus, "model": model, "estimator": loaded.name, **show.plain(scores)})
        return
    show.text(f"{loaded.name} trained on {loaded.corpus}, tested on {corpus}:", "")
    _show_scores(scores)


def _warn_of_severities(*tested: "Scores | Results | None") -> None:
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


@click.command()
@corpus_argument
@folder_option("OUTDIR", "Folder for report.html and results.json.")
@click.option(
    "--test",
    type=A_PATH,
    metavar="DIR2",
    callback=corpus_folder,
    help="Another corpus to test on, such as real recordings.",
)
@click.option(
    "--by",
    type=click.Choice(["specimen", "rig"]),
    default="specimen",
    show_default=True,
    help="Unit whose records all stay on one side of a split.",
)
@click.option(
    "--folds", type=click.IntRange(min=2), metavar="K", default=5, show_default=True, help="Number of splits."
)
@click.option(
    "--seed", type=int, default=0, show_default=True, metavar="S", help="Seed of splits, classifiers and bootstrap."
)
@json_option
def benchmark(corpus: Path, output: Path, test: Path | None, by: Any, folds: int, seed: int, as_json: bool) -> None:
    """Measure the scores of all baselines on DIR.

    (raceway bench measures speed.) Cross-validation keeps all records of a specimen (or rig) on one side of each split. Two controls
    are shown beside each score: a split of random records, which leaks, and labels permuted among specimens, which must score at chance.
    With --test, models trained on all of DIR are also scored on DIR2.

      raceway benchmark corpus -o report
      raceway benchmark corpus --test cwru -o report --by rig
    """
    from features.baselines import benchmark as run
    from features.report.page import write_report

    table = _table(corpus)
    other = None if test is None else _table(test)
    with progress("scoring", "baselines") as report:
        results = run(table, other, by=by, folds=folds, seed=seed, progress=report)
    _warn_of_severities(results, next(iter(results.baselines.values())).test)
    page = write_report(corpus, results, output)
    if as_json:
        show.as_json({"report": page, "results": output / "results.json", **show.plain(results)})
        return
    show.text(f"Balanced accuracy on {results.corpus.title}, {folds} folds by {by}:", "")
    _show_baselines(results.baselines)
    show.text("", f"{page}: the complete report.")


def _show_baselines(baselines: "Mapping[str, Baseline]") -> None:
    from features.baselines import interval_text

    def figures(baseline: "Baseline") -> list[str]:
        shown = [f"{baseline.grouped.balanced_accuracy:.3f}", interval_text(baseline.grouped.interval, 2)]
        shown += [f"{control.balanced_accuracy:.3f}" for control in (baseline.leaky, baseline.null)]
        return shown if baseline.test is None else [*shown, f"{baseline.test.balanced_accuracy:.3f}"]

    tested = any(baseline.test is not None for baseline in baselines.values())
    header = ("baseline", "score", "95 %", "leaky split", "null labels", *(("other corpus",) if tested else ()))
    show.table(header, ((name, *figures(baseline)) for name, baseline in baselines.items()))


@click.command()
@recipe_argument
@click.option(
    "--records",
    type=click.IntRange(min=1),
    metavar="N",
    help="Number of records to time; by default those of one part.",
)
@json_option
def bench(recipe: str, records: int | None, as_json: bool) -> None:
    """Measure the speed of this machine on RECIPE.

    (raceway benchmark measures scores.) One worker makes the first part of the corpus several times, stage by stage, and discards it;
    the medians are shown. Integration steps are counted for records, settling time included, and not for empty lanes.

      raceway bench quickstart
    """
    from gen.recipe import find_recipe

    find_recipe(recipe)
    from raceway.studies.timing import bench as run

    with compilation_noticed():
        found = run(recipe, records)
    if as_json:
        show.as_json(found)
        return
    show.text(
        f"{found.recipe}: {show.counted(found.records, 'record')}, median of {show.counted(found.repeats, 'run')} on "
        f"{found.machine['processor']}",
        "",
    )
    show.table(
        ("stage", "ms per record"),
        ((name, f"{1e3 * s / found.records:.3g}") for name, s in found.stage_seconds.items()),
    )
    show.text("")
    show.facts(
        {
            "kernel": f"{found.kernel_record_steps_per_second / 1e6:,.3g} million record-steps/s",
            "corpus": f"{found.records_per_second:,.3g} records/s",
            "features": f"{found.features_records_per_second:,.3g} records/s",
        }
    )
