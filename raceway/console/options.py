"""Arguments and options that several commands share; the place for the result is checked before any work is done."""

import math
from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import Any, NamedTuple, cast

import click
from click.shell_completion import CompletionItem

Decorator = Callable[[Any], Any]

FEW_RECORDS = 2000  # their features take about as long as processes take to start
A_PATH = click.Path(path_type=Path)
REFERENCE_MODEL = "reference"


class _Model(click.Path):
    """A model file, or None for the reference model; ``./reference`` is a file."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        return None if value == REFERENCE_MODEL else super().convert(value, param, ctx)


class _Corpus(click.Path):
    """Folder or single file of a corpus; ``index.nc`` stands for its folder."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        path = cast("Path", super().convert(value, param, ctx))
        return path.parent if path.name == "index.nc" and path.is_file() else path


A_MODEL = _Model(path_type=Path)
A_CORPUS = _Corpus(path_type=Path)


def complete_recipes(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    """Recipes that ship with Raceway, and files."""
    from gen.recipe import shipped_recipes  # not at the top: help needs nothing of gen

    named = [CompletionItem(name) for name in shipped_recipes() if name.startswith(begun)]
    return named or [CompletionItem(begun, type="file")]


json_option: Decorator = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
model_option: Decorator = click.option(
    "--model",
    type=A_MODEL,
    default=REFERENCE_MODEL,
    show_default=True,
    metavar="MODEL",
    help="Model file of raceway train, or reference: the reference model, which is trained at its first use. A file of this name is "
    "./reference.",
)
recipe_argument: Decorator = click.argument("recipe", shell_complete=complete_recipes)
corpus_argument: Decorator = click.argument("corpus", metavar="DIR", type=A_CORPUS)
record_option: Decorator = click.option(
    "--record", type=int, required=True, metavar="I", help="Number of the record, from 0."
)
seed_option: Decorator = click.option("--seed", type=int, metavar="S", help="Replaces the seed of the recipe.")
records_option: Decorator = click.option(
    "--records", type=int, metavar="N", help="Make N records: the first ones of the recipe, or more from further rigs."
)

workers_option: Decorator = click.option(
    "--workers",
    type=click.IntRange(min=1),
    metavar="N",
    help="Number of processes on this machine; by default one per core, and one alone for little work.",
)
_scheduler: Decorator = click.option(
    "--scheduler", metavar="ADDR", help="Address of a dask scheduler, in place of --workers."
)


def gathered(name: str, kind: Any, *options: Decorator) -> Decorator:
    """Make options whose values, named as fields of the named tuple ``kind``, the command gets as one argument of a name."""

    def decorator(command: Any) -> Any:
        @wraps(command)
        def gather(**values: Any) -> Any:
            # what belongs together stays together in the command
            values_of_kind = kind(**{field: values.pop(field) for field in kind._fields if field in values})
            return command(**{name: values_of_kind}, **values)

        decorated = gather
        for option in reversed(options):
            decorated = option(decorated)
        return decorated

    return decorator


class Team(NamedTuple):
    """Values of the options ``--workers`` and ``--scheduler``."""

    workers: int | None = None
    scheduler: str | None = None

    def options(self, records: int = FEW_RECORDS) -> dict[str, Any]:
        """Arguments ``workers`` and ``scheduler`` of a function that works on parts of so many records in all."""
        from gen.support.executor import cores  # not at the top: help needs nothing of gen

        usual = cores() if records > FEW_RECORDS else 1
        return {"workers": self.workers or usual, "scheduler": self.scheduler}


USUAL = Team()
worker_options = gathered("team", Team, workers_option, _scheduler)


class Analysis(NamedTuple):
    """Values of ``--channel``, ``--band`` and ``--group``; None for the first channel and for the default band."""

    channel: str | tuple[str, ...] | None = None
    band: tuple[float, float] | None = None
    groups: tuple[str, ...] = ()

    def with_groups(self, groups: Iterable[str]) -> tuple[str, ...]:
        """Some groups of features, then those of ``--group``."""
        return tuple(dict.fromkeys((*groups, *self.groups)))

    def options(self) -> dict[str, Any]:
        """Arguments ``channel`` and ``band`` of a function of features."""
        from features.table.band import DEFAULT_BAND, Band  # not at the top: help needs nothing of features

        return {"channel": self.channel or 0, "band": Band(*(self.band or DEFAULT_BAND))}


USUAL_ANALYSIS = Analysis()


def _checked_band(
    _context: click.Context, _option: click.Parameter, edges: tuple[float, float] | None
) -> tuple[float, float] | None:
    if edges is None:
        return None
    from features.table.band import checked_band

    try:
        return checked_band(*edges)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


channel_option: Decorator = click.option(
    "--channel", metavar="NAME", help="Channel by its name; by default the first (raceway info DIR lists them)."
)


def names(_context: click.Context, _option: click.Parameter, text: str | None) -> tuple[str, ...] | None:
    """Names separated by commas."""
    if text is None:
        return None
    words = tuple(name.strip() for name in text.split(","))
    if not all(words):
        raise click.BadParameter(f"{text!r} has an empty name; separate names by one comma")
    return words


def finite(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    """Finite number, since nan passes every range and inf those without an upper end."""
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(f"{value} is not a finite number")
    return value


channels_option: Decorator = click.option(
    "--channel",
    metavar="NAME[,NAME]",
    callback=names,
    help="Channel by its name, or several, such as the axes of one housing; by default the first (raceway info DIR lists them).",
)
band_option: Decorator = click.option(
    "--band",
    type=(float, float),
    metavar="LOW HIGH",
    callback=_checked_band,
    help="Band of the envelopes [Hz], by default 300 5000; for sensors with a resonance above it.",
)


def _known_groups(_context: click.Context, _option: click.Parameter, groups: tuple[str, ...]) -> tuple[str, ...]:
    if groups:
        from features.table.definitions import ALL_GROUPS

        if unknown := [group for group in groups if group not in ALL_GROUPS]:
            raise click.BadParameter(f"{unknown[0]!r} is no group of features; choose from {', '.join(ALL_GROUPS)}")
    return groups


group_option: Decorator = click.option(
    "--group",
    "groups",
    multiple=True,
    metavar="NAME",
    callback=_known_groups,
    help="Take this group of features too (raceway features --list), such as one of a plug-in; train and benchmark take lines and "
    "shape anyway, features all built-in ones. Repeatable.",
)
analysis_options = gathered("analysis", Analysis, channel_option, band_option)
training_options = gathered("analysis", Analysis, channel_option, band_option, group_option)

where_option: Decorator = click.option(
    "--where",
    metavar="TEXT",
    help="Only records that meet this condition, such as \"fault == 'inner' and width_mm > 0.5\".",
)
_split: Decorator = click.option(
    "--split", metavar="NAME", help="Only records of this split: train, validation or test."
)
_channels: Decorator = click.option(
    "--channels", metavar="NAME[,NAME]", callback=names, help="Only these channels, in the order of the corpus."
)


def choice_options(command: Any) -> Any:
    """Add the options ``--where``, ``--split`` and ``--channels``, which choose records and channels of a corpus."""
    return where_option(_split(_channels(command)))


speed_option: Decorator = click.option(
    "--speed",
    type=click.Choice(["off", "check", "correct"]),
    default="check",
    show_default=True,
    help="Compare the labelled shaft speeds of real recordings with their lines and warn (check), or use the estimated speed "
    "where it is clear (correct).",
)


def target_option(what: str) -> Decorator:
    """Make the option that names a new corpus, which lies in no other: a file if the name ends in .nc, else a folder."""

    def check(_context: click.Context, _option: click.Parameter, path: Path) -> Path:
        from gen.corpus import check_place  # not at the top: help needs nothing of gen

        check_place(path)
        return path

    return click.option("-o", "--output", type=A_PATH, required=True, metavar="TARGET", help=what, callback=check)


def checked_pages(_context: click.Context, _option: click.Parameter, path: Path | None) -> Path | None:
    """Folder for pages and pictures, which is no corpus and lies in none."""
    if path is None:
        return None
    from gen.corpus import check_result_folder  # not at the top: help needs nothing of gen

    if path.exists() and not path.is_dir():
        raise click.BadParameter(f"{path} is a file; give a folder")
    if path.suffix == ".html":
        raise click.BadParameter(f"{path} is the name of a page; give that of a folder")
    check_result_folder(path)
    return path


def pages_option(metavar: str, what: str, *, required: bool = True) -> Decorator:
    """Make the option that names the folder for pages and pictures, which is no corpus and lies in none."""
    told = f"{what} Earlier ones are replaced."
    options: Any = {"type": A_PATH, "required": required, "metavar": metavar, "help": told, "callback": checked_pages}
    return click.option("-o", "--output", **options)


def checked_file(path: Path, suffixes: tuple[str, ...] = (), kind: str | None = None) -> Path:
    """File for a result; see :func:`file_option`."""
    if suffixes and path.suffix not in suffixes:
        raise click.BadParameter(f"{path} does not end in {' or '.join(suffixes)}")
    if path.is_dir():
        raise click.BadParameter(f"{path} is a folder; give a file")
    if not path.parent.is_dir():
        raise click.BadParameter(f"there is no folder {path.parent}; create it first")
    from gen.corpus import check_result  # not at the top: help needs nothing of gen

    check_result(path, kind)
    return path


def file_option(
    metavar: str,
    what: str,
    suffixes: tuple[str, ...] = (),
    *,
    kind: str | None = None,
    required: bool = True,
    flags: tuple[str, ...] = ("-o", "--output"),
) -> Decorator:
    """Make the option that names the file for a result, with any suffix or with one of ``suffixes``.

    Only a file of the same ``kind`` is replaced, one of `gen.corpus.outputs`; none if it is None.
    """

    def check(_context: click.Context, _option: click.Parameter, path: Path | None) -> Path | None:
        return None if path is None else checked_file(path, suffixes, kind)

    told = what if kind is None else f"{what} An earlier one is replaced."
    return click.option(*flags, type=A_PATH, required=required, metavar=metavar, help=told, callback=check)


picture_option = file_option("PICTURE", "Picture: .png, .svg or .pdf.", (".png", ".svg", ".pdf"), kind="picture")
