"""Command that writes a recipe of a machine from recordings of it with a healthy bearing."""

from pathlib import Path
from typing import Any

import click

from raceway.console import show
from raceway.console.options import A_PATH, file_option, finite, json_option
from raceway.console.progress_bar import next_step, notice_compilation, warn
from raceway.importing.reading_options import Reading, Speeds, reading_options, rpm_option


@click.command()
@click.argument("recordings", metavar="RECORDING...", type=A_PATH, nargs=-1, required=True)
@click.option(
    "--bearing",
    required=True,
    metavar="BEARING",
    help="Designation in the catalogue, such as 6205, or a geometry: n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938.",
)
@rpm_option("by default the one that the first file states")
@click.option(
    "--load-n", type=click.FloatRange(1, 1e7), callback=finite, metavar="N", help="Radial load of the bearing."
)
@click.option("--synthetic", is_flag=True, help="Estimate the background; the page alone then shows the recording.")
@reading_options
@file_option(
    "RECIPE", "The recipe, .yaml. Its page has the same name, and so has the recording that is kept.", (".yaml",)
)
@json_option
def imitate(
    recordings: tuple[Path, ...], output: Path, speeds: Speeds | None, reading: Reading, as_json: bool, **machine: Any
) -> None:
    """Write a recipe of a machine from healthy recordings.

    RECORDING is a file as for raceway diagnose, of a machine with a healthy bearing; several have the same channels and rate. A healthy
    record of the recipe is a segment of the recording, and a faulty one a segment and what a fault of the model adds. Comments in the
    recipe tell where each value comes from. A page compares healthy records with the recording.

      raceway imitate healthy.csv --bearing 6205 --rpm 1772 --unit g -o machine.yaml
      raceway imitate monday.csv tuesday.csv --bearing 6205 --rpm 1772 --load-n 500 -o machine.yaml
      raceway imitate healthy.csv --bearing 6205 --rpm 1772 --synthetic -o shared.yaml

    Next: raceway generate RECIPE -o DIR
    """
    from raceway.imitating import imitate as run

    with notice_compilation():
        done = run(recordings, output, rpm=speeds, **machine, **reading._asdict())
    for sentence in done.warnings:
        warn(sentence)
    if as_json:
        show.as_json(done._asdict())
        return
    show.text(
        "AUC of the recording against healthy records; 0.5: alike, 1: all values of the recording are higher:", ""
    )
    show.table(("measure", "AUC"), [[name, "" if auc is None else f"{auc:.2f}"] for name, auc in done.auc.items()])
    show.text("", f"{done.page}: pictures.")
    next_step(f"raceway generate {done.recipe} -o corpus")
