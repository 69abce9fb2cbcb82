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


def _window(default: float) -> Any:
    return click.option(
        "--window", type=float, default=default, show_default=True, metavar="S", help="Length of a record [s]."
    )


def _keys(_context: click.Context, _option: click.Parameter, texts: tuple[str, ...]) -> dict[str, str]:
    """Keys and their values, as they are written."""
    for text in texts:
        if not text.partition("=")[2]:
            raise click.BadParameter(f"{text!r} is not KEY=VALUE, such as unit=g")
    return dict(text.split("=", 1) for text in texts)


_set: Any = click.option(
    "--set", "settings", multiple=True, metavar="KEY=VALUE", callback=_keys, help="Key of all files; can be repeated."
)


def _make(name: str) -> click.Command:
    """Command of a published set, or of the importer of a plug-in."""
    from raceway.importing.published import published_sets

    return _of_set(name) if name in published_sets() else _of_plugin(name)


def _of_set(name: str) -> click.Command:
    from raceway.importing.published import ALL, UNTRIED, import_set, published_sets

    published = published_sets()[name]
    state = "" if published.tried else f" Its table of labels is {UNTRIED}."
    layout = "SRC is the folder of the published files; they may be in subfolders."
    layout += "" if "unit" in published.common else " The description states no unit: give --set unit=g or another."
    told = f"{published.help}{state}\n\n{layout}\n\n  raceway import {name} SRC -o {name}"

    @click.command(name, help=told)
    @_source
    @_output
    @_window(published.window_s)
    @_set
    @json_option
    def convert(source: Path, output: Path, as_json: bool, settings: dict[str, str], **options: Any) -> None:
        _run(lambda report: import_set(name, source, output, common=settings, progress=report, **options), as_json)

    if published.subsets:
        choices = f"All recordings, or {', '.join(f'{key}: {words}' for key, words in published.subsets.items())}."
        subset: Any = click.option(
            "--subset", type=click.Choice([ALL, *published.subsets]), default=ALL, show_default=True, help=choices
        )
        subset(convert)
    return convert


def _of_plugin(name: str) -> click.Command:
    from gen.support.plugins import plugin  # not at the top: help needs nothing of gen
    from raceway.importing.assemble import Importer

    importer = plugin("importers", name, Importer)

    @click.command(name, help=importer.help)
    @_source
    @_output
    @_window(0.5)
    @json_option
    def convert(source: Path, output: Path, window: float, as_json: bool) -> None:
        _run(lambda report: importer.convert(source, output, window=window, progress=report), as_json)

    return convert


class _Importers(PluginGroup):
    """Commands of published sets and of plug-ins beside ``generic``."""

    def added(self) -> list[str]:
        from raceway.importing.published import published_sets

        return [*dict.fromkeys((*published_sets(), *super().added()))]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        # without the sets, whose table takes 0.2 s to read
        return self.commands.get(cmd_name) or super().get_command(ctx, cmd_name)


@click.group("import", cls=_Importers, plugins="raceway.importers", make=_make)
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
@_window(0.5)
@click.option("--folder", type=A_PATH, metavar="DIR", help="Folder of the recordings; by default that of SRC.")
@_set
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
