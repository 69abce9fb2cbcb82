"""Command that compares synthetic records with real ones."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.corpus_table import notice_of_unknown
from raceway.console.options import A_CORPUS, json_option, pages_option
from raceway.console.progress_bar import progress

if TYPE_CHECKING:
    from raceway.comparing import Comparison


@click.command()
@click.argument("synthetic", metavar="SYN", type=A_CORPUS)
@click.argument("real", metavar="REAL...", type=A_CORPUS, nargs=-1, required=True)
@pages_option("OUTDIR", "Folder for report.html and comparison.json.")
@click.option(
    "--top",
    type=click.FloatRange(min=1000.0),
    default=5000.0,
    show_default=True,
    metavar="HZ",
    help="Upper edge of the compared band.",
)
@click.option(
    "--window",
    type=click.FloatRange(min=0.05),
    metavar="S",
    help="Length that records are cut to [s]; by default that of the shortest.",
)
@click.option(
    "--records",
    type=click.IntRange(min=10),
    default=500,
    show_default=True,
    metavar="N",
    help="Largest number of windows of each class and corpus.",
)
@json_option
def compare(
    synthetic: Path, real: tuple[Path, ...], output: Path, top: float, window: float | None, records: int, as_json: bool
) -> None:
    """Compare synthetic records with real ones.

    Each class of the corpus SYN is compared with the same class of the others, in 15 measures of the signal. Every REAL is a corpus of
    real recordings (raceway import). The AUC of a measure is the probability that a real record has a higher value than a synthetic
    one: 0.5 if they are alike. With two or more REAL, each is also compared with the others: the yardstick.

      raceway compare corpus cwru mfpt -o realism
    """
    from raceway.comparing import compare as run
    from raceway.comparing.comparison_page import write_comparison

    with progress("measuring", "corpora") as report:
        comparison = run(synthetic, real, top=top, window=window, records=records, progress=report)
    for windows in (comparison.synthetic, *comparison.real):
        notice_of_unknown(windows.folder, windows.unknown)
    page = write_comparison(comparison, output)
    if as_json:
        show.as_json(comparison.plain() | {"report": page})
        return
    _show(comparison)
    show.text("", f"{page}: quantiles, yardstick and pictures.")


def _show(comparison: "Comparison") -> None:
    show.text("AUC of real against synthetic records; 0.5: alike, 1: all real values are higher:", "")
    names = list(dict.fromkeys(name for table in comparison.auc.values() for name in table))
    rows = [[name, *(_cell(table.get(name)) for table in comparison.auc.values())] for name in names]
    show.table(("measure", *comparison.auc), rows)


def _cell(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"
