"""Commands that convert real recordings into the corpus format."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show
from raceway.console.options import A_PATH, json_option, target_option
from raceway.console.plugin_commands import PluginGroup
from raceway.console.progress_bar import notice, progress, warn

if TYPE_CHECKING:
    from collections.abc import Callable

    from raceway.importing import Import


def _keys(_context: click.Context, _option: click.Parameter, texts: tuple[str, ...]) -> dict[str, str]:
    """Keys and their values, as they are written."""
    for text in texts:
        if not text.partition("=")[2]:
            raise click.BadParameter(f"{text!r} is not KEY=VALUE, such as unit=g")
    return dict(text.split("=", 1) for text in texts)


_source: Any = click.argument("source", metavar="SRC", type=A_PATH)
_output: Any = target_option("The new corpus: a file if the name ends in .nc, else a folder.")
_set: Any = click.option(
    "--set", "common", multiple=True, metavar="KEY=VALUE", callback=_keys, help="Key of all files; can be repeated."
)


def _window(default: float) -> Any:
    return click.option(
        "--window", type=float, default=default, show_default=True, metavar="S", help="Length of a record [s]."
    )


def _command(name: str, told: str, bring: "Callable[..., Import]", *options: Any) -> click.Command:
    """Command of an importer of folders, which is called with the values of its ``options``."""

    def convert(source: Path, output: Path, as_json: bool, **values: Any) -> None:
        with progress("importing", "files") as report:
            done = bring(source, output, progress=report, **values)
        for sentence in done.warnings:
            warn(sentence)
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

    for option in reversed((_source, _output, *options, json_option)):
        convert = option(convert)
    return click.command(name, help=told)(convert)


def _of_name(name: str) -> click.Command:
    """Command of a published set, or of the importer of a plug-in."""
    from gen.support.plugins import plugin  # not at the top: help needs nothing of gen
    from raceway.importing.assemble import Importer
    from raceway.importing.published import ALL, UNTRIED, import_set, published_sets

    if name not in published_sets():
        importer = plugin("importers", name, Importer)
        return _command(name, importer.help, importer.convert, _window(0.5))
    published = published_sets()[name]
    state = "" if published.tried else f" Its table of labels is {UNTRIED}."
    layout = "SRC is the folder of the published files; they may be in subfolders."
    layout += "" if "unit" in published.common else " The description states no unit: give --set unit=g or another."
    told = f"{published.help}{state}\n\n{layout}\n\n  raceway import {name} SRC -o {name}"
    subsets = ", ".join(f"{key}: {words}" for key, words in published.subsets.items())
    subset: Any = click.option(
        "--subset",
        type=click.Choice([ALL, *published.subsets]),
        default=ALL,
        show_default=True,
        help=f"All recordings, or {subsets}.",
    )
    chosen = [subset] if subsets else []
    return _command(name, told, partial(import_set, name), _window(published.window_s), *chosen, _set)


class _Importers(PluginGroup):
    """Commands of published sets and of plug-ins beside ``generic``."""

    def added(self) -> list[str]:
        from raceway.importing.published import published_sets

        return [*dict.fromkeys((*published_sets(), *super().added()))]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        # without the sets, whose table takes 0.2 s to read
        return self.commands.get(cmd_name) or super().get_command(ctx, cmd_name)


@click.group("import", cls=_Importers, plugins="raceway.importers", make=_of_name)
def import_() -> None:
    """Convert real recordings into the corpus format.

    Raceway ships no recordings; give the folder of your own copy. Each recording is cut into records of --window seconds. A file that
    cannot be used is skipped with a sentence, and each assumption is a warning; both lists are kept in the corpus (raceway info DIR).

      raceway import cwru 12k_drive_end -o cwru
      raceway evaluate cwru --model model.skops
    """


def _generic(*arguments: Any, **options: Any) -> "Import":
    from raceway.importing import import_generic

    return import_generic(*arguments, **options)


_folder: Any = click.option(
    "--folder", type=A_PATH, metavar="DIR", help="Folder of the recordings; by default that of SRC."
)
_GENERIC = """Your own recordings, described by a table of labels.

    SRC is a table saved as CSV in the folder of the recordings, one row for each file:

      path,fault,specimen,shaft_rpm
      new/1.csv,healthy,new,1480
      worn/1.csv,outer,worn,1475

    Keys that all files share are in labels.yaml beside labels.csv, or options:

      raceway import generic labels.csv -o pump7 --set bearing=6205 --set unit=g --set sample_rate_hz=25600
    """
import_.add_command(_command("generic", _GENERIC, _generic, _window(0.5), _folder, _set))
