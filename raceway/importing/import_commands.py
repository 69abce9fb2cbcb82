"""Commands that convert real recordings into the corpus format."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show
from raceway.console.options import A_PATH, json_option, target_option
from raceway.console.plugin_commands import PluginGroup
from raceway.console.progress_bar import notice, progress

if TYPE_CHECKING:
    from collections.abc import Callable

    from raceway.importing import Import

_source: Any = click.argument("source", metavar="SRC", type=A_PATH)
_output: Any = target_option("The new corpus: a file if the name ends in .nc, else a folder.")
_window: Any = click.option(
    "--window", type=float, default=0.5, show_default=True, metavar="S", help="Length of a record [s]."
)


def _keys(_context: click.Context, _option: click.Parameter, texts: tuple[str, ...]) -> dict[str, str]:
    """Keys and their values, as they are written."""
    for text in texts:
        if not text.partition("=")[2]:
            raise click.BadParameter(f"{text!r} is not KEY=VALUE, such as unit=g")
    return dict(text.split("=", 1) for text in texts)


def _of_plugin(name: str) -> click.Command:
    """Command of the importer of a plug-in."""
    from gen.support.plugins import plugin  # not at the top: help needs nothing of gen
    from raceway.importing.assemble import Importer

    importer = plugin("importers", name, Importer)

    @click.command(name, help=importer.help)
    @_source
    @_output
    @_window
    @json_option
    def convert(source: Path, output: Path, window: float, as_json: bool) -> None:
        _run(lambda report: importer.convert(source, output, window=window, progress=report), as_json)

    return convert


@click.group("import", cls=PluginGroup, plugins="raceway.importers", make=_of_plugin)
def import_() -> None:
    """Convert real recordings into the corpus format.

    Raceway ships no recordings; give the folder of your own copy. Each recording is cut into records of --window seconds. A file that
    cannot be used is skipped with a sentence, and each assumption is a warning; both lists are kept in the corpus (raceway info DIR).

      raceway import cwru 12k_drive_end -o cwru
      raceway evaluate cwru --model model.skops
    """


@import_.command()
@_source
@_output
@_window
@click.option(
    "--subset",
    type=click.Choice(["all", "wang"]),
    default="all",
    show_default=True,
    help="All 64 recordings, or the 40 of Wang, Taal and Fink (2021).",
)
@json_option
def cwru(source: Path, output: Path, window: float, subset: Any, as_json: bool) -> None:
    """Case Western Reserve University, drive end, 12 kHz.

    SRC is the folder of the published MATLAB files; they may be in subfolders.

      raceway import cwru SRC -o cwru --subset wang
    """
    from raceway.importing import import_cwru

    _run(lambda report: import_cwru(source, output, window=window, subset=subset, progress=report), as_json)


@import_.command()
@_source
@_output
@_window
@json_option
def mfpt(source: Path, output: Path, window: float, as_json: bool) -> None:
    """MFPT fault data set of Bechhoefer, 48,828 Hz.

    SRC is the folder of the published MATLAB files; they may be in subfolders.

      raceway import mfpt SRC -o mfpt
    """
    from raceway.importing import import_mfpt

    _run(lambda report: import_mfpt(source, output, window=window, progress=report), as_json)


@import_.command()
@_source
@_output
@json_option
def femto(source: Path, output: Path, as_json: bool) -> None:
    """PRONOSTIA run-to-failure tests of FEMTO-ST, IEEE PHM 2012.

    SRC is the folder of the published folders Bearing1_1, ...; they may be in subfolders. Each file is one record of a life.

      raceway import femto Learning_set -o pronostia
    """
    from raceway.importing import import_femto

    _run(lambda report: import_femto(source, output, progress=report), as_json)


@import_.command()
@_source
@_output
@_window
@click.option("--folder", type=A_PATH, metavar="DIR", help="Folder of the recordings; by default that of SRC.")
@click.option(
    "--set", "settings", multiple=True, metavar="KEY=VALUE", callback=_keys, help="Key of all files; can be repeated."
)
@json_option
def generic(
    source: Path, output: Path, window: float, folder: Path | None, settings: dict[str, str], as_json: bool
) -> None:
    """Your own recordings, described by a table of labels.

    SRC is a table saved as CSV in the folder of the recordings (MATLAB, text, Excel, NumPy or WAV), one row for each file:

      path,fault,specimen,shaft_rpm
      new/1.csv,healthy,new,1480
      worn/1.csv,outer,worn,1475

    Keys that all files share are in labels.yaml beside labels.csv, or options:

      raceway import generic labels.csv -o pump7 --set bearing=6205 --set unit=g --set sample_rate_hz=25600
    """
    from raceway.importing import import_generic

    _run(
        lambda report: import_generic(source, output, window=window, folder=folder, common=settings, progress=report),
        as_json,
    )


def _run(bring: "Callable[[Any], Import]", as_json: bool) -> None:
    with progress("importing", "files") as report:
        done = bring(report)
    for sentence in done.warnings:
        notice(f"warning: {sentence}")
    for sentence in done.skipped:
        notice(sentence)
    if as_json:
        facts = done._asdict()
        show.as_json({"corpus": facts.pop("path"), **facts})
        return
    show.text(
        f"{done.path}: {show.count_text(done.records, 'record')} of {show.count_text(done.recordings, 'recording')}; "
        f"{show.count_text(len(done.skipped), 'file')} skipped, {show.count_text(len(done.warnings), 'warning')}."
    )
