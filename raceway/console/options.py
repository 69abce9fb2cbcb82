"""Arguments and options that several commands share; where a file is to go is checked before any work is done."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

Decorator = Callable[[Any], Any]

A_PATH = click.Path(path_type=Path)

json_option: Decorator = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
recipe_argument: Decorator = click.argument("recipe")
corpus_argument: Decorator = click.argument("corpus", metavar="DIR", type=A_PATH)
record_option: Decorator = click.option(
    "--record", type=int, required=True, metavar="I", help="Number of the record, from 0."
)
seed_option: Decorator = click.option("--seed", type=int, metavar="S", help="Take the place of the recipe's seed.")
records_option: Decorator = click.option("--records", type=int, metavar="N", help="Make only the first N records.")


def folder_option(metavar: str, what: str) -> Decorator:
    """Make the option that names the folder for the result."""
    return click.option("-o", "--output", type=A_PATH, required=True, metavar=metavar, help=what, callback=_folder)


def file_option(metavar: str, what: str, suffixes: tuple[str, ...] = (), *, required: bool = True) -> Decorator:
    """Make the option that names the file for the result, of any kind or with one of ``suffixes``."""

    def check(_context: click.Context, _option: click.Parameter, path: Path | None) -> Path | None:
        if path is None:
            return None
        if suffixes and path.suffix not in suffixes:
            raise click.BadParameter(f"{path} does not end in {' or '.join(suffixes)}")
        if path.is_dir():
            raise click.BadParameter(f"{path} is a folder; give a file")
        if not path.parent.is_dir():
            raise click.BadParameter(f"there is no folder {path.parent}; make it first")
        return path

    return click.option("-o", "--output", type=A_PATH, required=required, metavar=metavar, help=what, callback=check)


def _folder(_context: click.Context, _option: click.Parameter, path: Path) -> Path:
    if path.exists() and not path.is_dir():
        raise click.BadParameter(f"{path} is a file; give a folder")
    return path
