"""Arguments and options that several commands share; the place for the result is checked before any work is done."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import click

Decorator = Callable[[Any], Any]

FEW_RECORDS = 2000  # their features take about as long as processes take to start; threads start at once
A_PATH = click.Path(path_type=Path)


def corpus_folder(_context: click.Context | None, _parameter: click.Parameter | None, path: Path | None) -> Path | None:
    """Folder of a corpus, or a packed file; ``corpus.nc`` of a corpus stands for its folder, and any other file is refused."""
    if path is None or not path.is_file():
        return path
    if path.name == "corpus.nc" and (path.parent / "manifest.json").is_file():
        return path.parent
    from gen.corpus.manifest import not_a_corpus  # not at the top: help needs nothing of gen
    from gen.corpus.packed import is_packed
    from gen.errors import CorpusError

    if is_packed(path):
        return path
    for folder in path.absolute().parents[:2]:
        if (folder / "manifest.json").is_file():
            raise CorpusError(f"{path}: is one file of a corpus; give the folder of the corpus, {folder}.")
    if path.name == "corpus.nc":
        raise CorpusError(not_a_corpus(path))
    what = "a feature table" if _is_table(path) else "a file"
    raise CorpusError(f"{path}: is {what}; give the folder of a corpus, the one that holds manifest.json.")


def _is_table(path: Path) -> bool:
    """Whether a file is a feature table in netCDF."""
    if path.suffix != ".nc":
        return False
    import h5py

    try:
        with h5py.File(path, "r", locking=False) as content:
            return {"features", "feature"} <= set(content)
    except OSError:
        return False


json_option: Decorator = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
recipe_argument: Decorator = click.argument("recipe")
corpus_argument: Decorator = click.argument("corpus", metavar="DIR", type=A_PATH, callback=corpus_folder)
record_option: Decorator = click.option(
    "--record", type=int, required=True, metavar="I", help="Number of the record, from 0."
)
seed_option: Decorator = click.option("--seed", type=int, metavar="S", help="Replaces the seed of the recipe.")
records_option: Decorator = click.option("--records", type=int, metavar="N", help="Make only the first N records.")

_workers: Decorator = click.option(
    "--workers",
    type=click.IntRange(min=1),
    metavar="N",
    help="Number of parts worked on at a time on this machine; by default one per core.",
)
_scheduler: Decorator = click.option(
    "--scheduler", metavar="ADDR", help="Address of a dask scheduler, in place of --workers."
)


class Team(NamedTuple):
    """Values of the options ``--workers`` and ``--scheduler``."""

    workers: int | None = None
    scheduler: str | None = None

    def options(self, records: int = FEW_RECORDS) -> dict[str, Any]:
        """Arguments ``workers`` and ``scheduler`` of a function that works on parts of so many records in all."""
        from gen.workers import MOST_THREADS  # not at the top: help needs nothing of gen

        usual = cores() if records > FEW_RECORDS else min(cores(), MOST_THREADS)
        return {"workers": self.workers or usual, "scheduler": self.scheduler}


USUAL = Team()


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def worker_options(command: Any) -> Any:
    """Add the options ``--workers`` and ``--scheduler``."""
    return _workers(_scheduler(command))


def _names(_context: click.Context, _option: click.Parameter, text: str | None) -> tuple[str, ...] | None:
    """Names separated by commas."""
    return None if text is None else tuple(name.strip() for name in text.split(","))


_where: Decorator = click.option(
    "--where",
    metavar="TEXT",
    help="Only records that meet this condition, such as \"fault == 'inner' and shaft_rate > 20\".",
)
_split: Decorator = click.option(
    "--split", metavar="NAME", help="Only records of this split: train, validation or test."
)
_channels: Decorator = click.option(
    "--channels", metavar="NAME[,NAME]", callback=_names, help="Only these channels, in the order of the corpus."
)


def choice_options(command: Any) -> Any:
    """Add the options ``--where``, ``--split`` and ``--channels``, which choose records and channels of a corpus."""
    return _where(_split(_channels(command)))


speed_option: Decorator = click.option(
    "--speed",
    type=click.Choice(["off", "check", "correct"]),
    default="check",
    show_default=True,
    help="Compare the labelled shaft speeds of real recordings with their lines and warn (check), or use the speed found "
    "where it is clear (correct).",
)


def folder_option(metavar: str, what: str) -> Decorator:
    """Make the option that names the folder for the result."""
    return click.option("-o", "--output", type=A_PATH, required=True, metavar=metavar, help=what, callback=_folder)


def file_option(metavar: str, what: str, suffixes: tuple[str, ...] = (), *, required: bool = True) -> Decorator:
    """Make the option that names the file for the result, with any suffix or with one of ``suffixes``."""

    def check(_context: click.Context, _option: click.Parameter, path: Path | None) -> Path | None:
        if path is None:
            return None
        if suffixes and path.suffix not in suffixes:
            raise click.BadParameter(f"{path} does not end in {' or '.join(suffixes)}")
        if path.is_dir():
            raise click.BadParameter(f"{path} is a folder; give a file")
        if not path.parent.is_dir():
            raise click.BadParameter(f"there is no folder {path.parent}; create it first")
        return path

    return click.option("-o", "--output", type=A_PATH, required=required, metavar=metavar, help=what, callback=check)


def _folder(_context: click.Context, _option: click.Parameter, path: Path) -> Path:
    if path.exists() and not path.is_dir():
        raise click.BadParameter(f"{path} is a file; give a folder")
    return path
