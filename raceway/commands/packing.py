"""Commands that make one file of a corpus, and a corpus of that file: pack, unpack."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.options import A_PATH, choice_options, corpus_argument, file_option, folder_option, json_option
from raceway.console.progress import notice, progress

if TYPE_CHECKING:
    from gen.corpus import Codec


@click.command()
@corpus_argument
@file_option("FILE.nc", "The packed file: a new name.", (".nc",))
@choice_options
@click.option("--float32", is_flag=True, help="Store accelerations in floating point in place of counts.")
@click.option(
    "--codec",
    type=click.Choice(["zlib", "zstd", "none"]),
    default="zlib",
    show_default=True,
    help="Compression of the signals; every netCDF-4 reader knows zlib.",
)
@json_option
def pack(
    corpus: Path,
    output: Path,
    where: str | None,
    split: str | None,
    channels: tuple[str, ...] | None,
    float32: bool,
    codec: "Codec",
    as_json: bool,
) -> None:
    """Pack the corpus in DIR into one netCDF-4 file.

    Any netCDF-4 reader opens the file, and raceway info, validate, plot, features, train and export take it in place of DIR. It holds the
    manifest, the recipe and the data card too, and unpack makes the same folder of it again. Every file of DIR is checked first.

      raceway pack corpus -o corpus_2026.nc
      raceway pack corpus -o tests.nc --split test
      raceway pack corpus -o inner.nc --where "fault == 'inner' and shaft_rate > 20" --channels housing_y
      raceway pack corpus -o for_matlab.nc --float32

    Next: raceway validate FILE.nc, raceway unpack FILE.nc -o DIR
    """
    from gen import pack as pack_corpus

    with progress("packing", "records") as report:
        made = pack_corpus(
            corpus, output, where=where, split=split, channels=channels, float32=float32, codec=codec, progress=report
        )
    if as_json:
        show.as_json(made._asdict())
        return
    size = f"{show.counted(made.records, 'record')} of {show.counted(made.parts, 'part')}, {show.size(made.bytes)}"
    show.text(f"{made.file}: {size}.", f"Next: raceway validate {shlex.quote(str(made.file))}")


@click.command()
@click.argument("file", metavar="FILE.nc", type=A_PATH)
@folder_option("DIR", "Folder of the corpus: new or empty.")
@json_option
def unpack(file: Path, output: Path, as_json: bool) -> None:
    """Make the corpus folder of a packed FILE.nc again.

    Every record is checked against its hash. Parts, recipe, manifest and data card are those that were packed, byte for byte; only with
    other versions of the netCDF libraries the parts can have other bytes around the same records.

      raceway unpack corpus_2026.nc -o corpus

    Next: raceway info DIR, raceway replay DIR --record I
    """
    from gen import unpack as unpack_corpus

    with progress("unpacking", "records") as report:
        made = unpack_corpus(file, output, progress=report)
    if not made.same_bytes:
        notice(
            "other versions of the libraries: the parts have other bytes and new hashes, their records are the same."
        )
    if as_json:
        show.as_json(made._asdict())
        return
    show.text(
        f"{made.directory}: {show.counted(made.records, 'record')} in {show.counted(made.parts, 'part')}.",
        f"Next: raceway info {shlex.quote(str(made.directory))}",
    )
