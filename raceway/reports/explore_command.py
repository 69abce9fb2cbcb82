"""Command that makes a page to browse a corpus."""

from pathlib import Path

import click

from raceway.console import show
from raceway.console.options import (
    A_PATH,
    Analysis,
    Team,
    analysis_options,
    corpus_argument,
    file_option,
    worker_options,
)
from raceway.console.progress_bar import progress


@click.command()
@corpus_argument
@file_option("PAGE", "Page: .html.", (".html",), kind="page")
@click.option("--features", "table", type=A_PATH, metavar="FILE", help="Feature table of DIR, for axes and conditions.")
@click.option(
    "--records",
    type=click.IntRange(min=1),
    default=10_000,
    show_default=True,
    metavar="N",
    help="Largest number of records on the page, evenly chosen.",
)
@analysis_options
@worker_options
def explore(
    corpus: Path,
    output: Path,
    table: Path | None,
    records: int,
    analysis: Analysis,
    team: Team,
) -> None:
    """Make a page to browse DIR in a web browser.

      raceway explore corpus -o explore.html
      raceway explore corpus -o explore.html --features features.nc --records 2000

    The page is one file and needs neither a server nor a network. It draws the records over two quantities of your choice, filters them
    by class, range and condition, and shows waveform, power spectral density, envelope spectrum with fault lines, waterfall and labels
    of the chosen record. In the page, the left and right keys choose a record and / goes to the condition.

    A record takes 1.5 kB on the page, and its features another 0.6 kB: 10,000 records are 15 MB.
    """
    from gen.corpus import read_manifest
    from raceway.reports.explore import write_explorer

    options = team.options(min(records, read_manifest(corpus).records)) | analysis.options()
    with progress("reading", "records") as report:
        shown, count = write_explorer(corpus, output, table=table, records=records, **options, progress=report)
    of_all = "" if shown == count else f" of {count:,}"
    size = output.stat().st_size / 1e6
    show.text(f"{output}: {shown:,}{of_all} records of {corpus}, {size:.1f} MB. Open it in a web browser.")
