"""Commands that measure: the scores of all baselines on a corpus, and the speed of this machine."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.commands.feature_tables import table_of
from raceway.commands.models import warn_of_severities
from raceway.console import show
from raceway.console.options import (
    A_PATH,
    corpus_argument,
    corpus_folder,
    folder_option,
    json_option,
    recipe_argument,
    speed_option,
)
from raceway.console.progress import compilation_noticed, progress

if TYPE_CHECKING:
    from features.baselines import Baseline
    from features.recording_speeds import Speed


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
@speed_option
@json_option
def benchmark(
    corpus: Path, output: Path, test: Path | None, by: Any, folds: int, seed: int, speed: "Speed", as_json: bool
) -> None:
    """Measure the scores of all baselines on DIR.

    (raceway bench measures speed.) Cross-validation keeps all records of a specimen (or rig) on one side of each split. Two controls
    are shown beside each score: a split of random records, which leaks, and labels permuted among specimens, which must score at chance.
    With --test, models trained on all of DIR are also scored on DIR2; --speed concerns DIR2 alone.

      raceway benchmark corpus -o report
      raceway benchmark corpus --test cwru -o report --by rig
    """
    from features.baselines import benchmark as run
    from features.report.page import write_report

    table = table_of(corpus)
    other = None if test is None else table_of(test, speed)
    with progress("scoring", "baselines") as report:
        results = run(table, other, by=by, folds=folds, seed=seed, progress=report)
    warn_of_severities(results, next(iter(results.baselines.values())).test)
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
