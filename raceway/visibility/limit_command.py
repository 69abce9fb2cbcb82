"""Command that tells the smallest faults that can be seen."""

from pathlib import Path

import click

from raceway.console import show
from raceway.console.corpus_table import table_of
from raceway.console.options import (
    A_CORPUS,
    Analysis,
    Team,
    analysis_options,
    complete_recipes,
    file_option,
    json_option,
    records_option,
    workers_option,
)
from raceway.console.progress_bar import progress, warn


@click.command()
@click.argument("source", metavar="RECIPE|DIR", type=A_CORPUS, shell_complete=complete_recipes)
@file_option("PICTURE", "Picture: .png, .svg or .pdf.", (".png", ".svg", ".pdf"), kind="picture", required=False)
@records_option
@analysis_options
@workers_option
@json_option
def limit(
    source: Path, output: Path | None, records: int | None, analysis: Analysis, workers: int | None, as_json: bool
) -> None:
    """Tell the smallest faults that can be seen.

    For each class of RECIPE, or of the corpus DIR: the size from which a fault is seen in half, and in nine of ten, of the records, with
    95 % intervals. twin: the record differs from the same record without its fault (detectable). classifier: it is more suspicious than
    99 % of the healthy records, by a training on other rigs, or on other specimens where there are too few rigs.

      raceway limit quickstart
      raceway limit my_machine.yaml --records 400 -o limit.png
      raceway limit corpus --json

    A row such as

      outer width  twin  0.131 mm (0.122 to 0.141)  0.163 mm (0.152 to 0.174)

    says that spalls of 0.163 mm on the outer race are seen in 90 % of the records, and those of 0.131 mm in half of them. It holds for
    records of this length: change duration_s of the recipe for others. Draw widths from too faint to plain, such as loguniform(0.05, 2),
    and make 100 or more records of each class, the healthy one too. With a recorded background, as of raceway imitate, the recording
    must be long enough for them, or the records shorter. The corpus of a recipe is not kept, and faults that cannot be seen
    are not drawn again; a corpus in which they were is refused. The picture has the share seen over the size.
    """
    from features.baselines.records import HEALTHY_CODE
    from features.table.durations import durations_of
    from gen.support.executor import cores
    from raceway.visibility import limit as limits_of
    from raceway.visibility.fault_limits import corpus_of
    from raceway.visibility.size_curves import FALSE_ALARMS

    with (
        progress("generating", "records") as report,
        corpus_of(source, records=records, workers=workers or cores(), progress=report) as corpus,
    ):
        table = table_of(corpus, team=Team(workers), analysis=analysis)
    with progress("fitting", "curves and classifiers") as report:
        limits = limits_of(table, progress=report)
    healthy = int((table["fault"] == HEALTHY_CODE).sum())
    if healthy * FALSE_ALARMS < 1:
        warn(
            f"{healthy} healthy records are too few for false alarms of 1 %: the classifier must exceed the highest of them; make "
            "100 or more. On a recorded background this needs a longer recording, or shorter records."
        )
    if output is not None:
        from raceway.reports.pictures import write_picture
        from raceway.visibility.limit_picture import draw_limits

        write_picture(draw_limits(limits), output)
    if as_json:
        show.as_json({"durations": durations_of(table), "limits": limits})
        return
    rows = [[f"{of.fault} {of.variable}", of.criterion, of.text(of.seen_50), of.text(of.seen_90)] for of in limits]
    show.table(("fault", "seen by", "in 50 % from", "in 90 % from"), rows)
    show.text(f"Records of {' to '.join(f'{duration:g}' for duration in dict.fromkeys(durations_of(table)))} s.")
