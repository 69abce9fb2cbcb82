"""Command that copies corpora: whole or in part, joined, as one file or a folder, or in a form for another program."""

import shlex
from pathlib import Path
from typing import Any

import click

from raceway.console import show
from raceway.console.options import A_CORPUS, choice_options, json_option, target_option
from raceway.console.progress_bar import next_step, notice, progress


def _new_names(_context: click.Context, _option: click.Parameter, pairs: tuple[str, ...]) -> dict[str, str]:
    """New names of channels by their old ones, from ``OLD=NEW``."""
    names = {old: new for old, _, new in (pair.partition("=") for pair in pairs)}
    if not all(old and new for old, new in names.items()) or len(names) < len(pairs):
        raise click.BadParameter("give OLD=NEW, once for each channel")
    return names


@click.command()
@click.argument("sources", metavar="SOURCE...", nargs=-1, required=True, type=A_CORPUS)
@target_option("The copy: a new name, or an empty folder.")
@choice_options
@click.option(
    "--rename-channel",
    "rename",
    multiple=True,
    metavar="OLD=NEW",
    callback=_new_names,
    help="New name of a channel, as sources of one corpus need the same; --channels takes the new name.",
)
@click.option(
    "--codec",
    type=click.Choice(["zlib", "zstd", "none"]),
    help="Compression of the signals of a corpus; by default zlib, which every netCDF-4 reader knows.",
)
@click.option("--float32", is_flag=True, help="Store accelerations in floating point in place of counts.")
@click.option("--to", metavar="FORM", help="Form of a folder for another program, see above.")
@json_option
def copy(sources: tuple[Path, ...], output: Path, to: str | None, as_json: bool, **choice: Any) -> None:
    """Copy corpora, or some of their records and channels.

    The name of TARGET gives the form:

      NAME            folder of a corpus
      NAME.nc         corpus in one netCDF-4 file, for MATLAB, R, Julia and Octave too
      NAME.parquet    one table: a row per record, for pandas, polars, DuckDB, Spark

    With --to it is a folder of files for another program:

      huggingface  Parquet by split with a card, for datasets.load_dataset

    Records keep samples, labels and splits, and simulated records can still be replayed. Several sources are joined, simulated and
    imported ones too. They need the same sample rate, length of records and channels. Rigs, specimens, recordings and pairs are then
    numbered anew, unless all records come from one corpus. Corpora that hold the same samples are refused, because a record in training
    and test set makes every score too good.

    A condition compares variables (docs/format.md) with numbers, or with texts in quotes. A quantity stands in SI units (width), and in
    those that people read (width_mm, width_um). For an unknown value (NaN) != and not in are true and all else is false.

      raceway copy corpus -o corpus.nc
      raceway copy corpus.nc -o fast_inner --where "fault in ('inner', 'outer') and shaft_rpm > 1200"
      raceway copy corpus -o test_set --split test --channels housing
      raceway copy simulated measured -o both --rename-channel fe=accelerometer --float32
      raceway copy corpus -o hub --to huggingface --where "not (bearing == '6205' or load <= 500)"

    Next: raceway info TARGET, raceway validate TARGET
    """
    from raceway.sharing import copy as copy_corpora

    with progress("copying", "records") as report:
        copied = copy_corpora(sources, output, to=to, **choice, progress=report)
    if copied.filled:
        notice(
            f"variables that one of the sources lacks are marked as not known in its records: {', '.join(copied.filled)}."
        )
    if as_json:
        show.as_json(copied._asdict())
        return
    size = f"{show.count_text(copied.files, 'file')}, {show.size(copied.bytes)}"
    channels_made = f"{show.count_text(len(copied.channels), 'channel')} ({', '.join(copied.channels)})"
    form = "" if copied.form in ("folder", "nc") else f" as {copied.form}"
    show.text(
        f"{output}: {copied.records:,} of {show.count_text(copied.of, 'record')}, {channels_made}{form} in {size}."
    )
    quoted = shlex.quote(str(output))
    if not form:
        next_step(f"raceway info {quoted}")
    elif to is not None:
        next_step(f"read {quoted}/README.md")
