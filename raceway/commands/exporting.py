"""Command that writes a corpus in the form of another program."""

import shlex
from pathlib import Path

import click

from raceway.console import show
from raceway.console.options import choice_options, corpus_argument, folder_option, json_option
from raceway.console.progress import progress

FORMS = ("parquet", "mat", "csv", "wav", "zarr", "huggingface")


@click.command()
@corpus_argument
@folder_option("OUT", "Folder of the export: new or empty.")
@click.option("--to", type=click.Choice(FORMS), required=True, help="Form of the export.")
@choice_options
@json_option
def export(
    corpus: Path,
    output: Path,
    to: str,
    where: str | None,
    split: str | None,
    channels: tuple[str, ...] | None,
    as_json: bool,
) -> None:
    """Write the corpus in DIR in a form for another program.

      parquet      one row per record, for pandas, polars, DuckDB, Spark
      mat          struct arrays for MATLAB and Octave
      csv          a table of labels, and one file per record
      wav          a table of labels, and one sound file per record
      zarr         a store that xarray opens
      huggingface  Parquet by split with a card, for datasets.load_dataset

    Labels and units go along, and OUT/README.md says how to read the files. The same corpus gives the same bytes. If the command is
    interrupted or killed, there is no OUT.

      raceway export corpus -o tables --to parquet
      raceway export corpus -o matlab --to mat --where "fault in ('healthy', 'inner')"
      raceway export corpus -o sounds --to wav --split test --channels housing

    Next: read OUT/README.md
    """
    from gen import export as export_corpus

    with progress("exporting", "records") as report:
        made = export_corpus(corpus, output, to, where=where, split=split, channels=channels, progress=report)
    if as_json:
        show.as_json(
            {"export": made.directory, **{key: value for key, value in made._asdict().items() if key != "directory"}}
        )
        return
    files = f"{show.counted(made.files, 'file')}, {show.size(made.bytes)}"
    show.text(f"{made.directory}: {show.counted(made.records, 'record')} as {made.to} in {files}.")
    show.text(f"Next: read {shlex.quote(str(made.directory / 'README.md'))}")
