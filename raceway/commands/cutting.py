"""Commands that choose records of a corpus and that join corpora: select, merge."""

import shlex
from pathlib import Path
from typing import Any

import click

from raceway.console import show
from raceway.console.options import A_PATH, choice_options, corpus_argument, corpus_folder, folder_option, json_option
from raceway.console.progress import notice, progress


@click.command()
@corpus_argument
@choice_options
@folder_option("OUT", "Folder of the new corpus: new or empty.")
@json_option
def select(
    corpus: Path,
    where: str | None,
    split: str | None,
    channels: tuple[str, ...] | None,
    output: Path,
    as_json: bool,
) -> None:
    """Write some records or channels of DIR as a corpus.

    Give at least one of --where, --split and --channels. Records keep all their numbers and labels, and the recipe is copied, so that
    every record can be replayed. A condition compares variables (raceway info DIR) with numbers, or with names in quotes:

      fault in ('inner', 'outer') and shaft_rate > 20
      not (bearing == '6205' or load <= 500) and split != 'test'

    It knows ==, !=, <, <=, >, >=, in, and, or, not and parentheses. A comparison with an unknown value (NaN) is false.

      raceway select corpus --where "fault == 'inner' and shaft_rate > 20" -o fast_inner
      raceway select corpus --split test --channels housing -o test_set

    Next: raceway info OUT, raceway merge OUT OTHER -o BOTH
    """
    from gen.sharing import select as select_records

    with progress("selecting", "records") as report:
        made = select_records(corpus, output, where=where, split=split, channels=channels, progress=report)
    if as_json:
        facts = {name: getattr(made, name) for name in ("records", "of", "parts", "channels")}
        show.as_json({"corpus": made.directory, **facts, "signals": made.signals._asdict()})
        return
    chosen = f"{made.records:,} of {show.counted(made.of, 'record')} in {show.counted(made.parts, 'part')}"
    show.text(
        f"{made.directory}: {chosen}, {show.counted(len(made.channels), 'channel')} ({', '.join(made.channels)})."
    )
    show.text(f"Next: raceway info {shlex.quote(str(made.directory))}")


def _folders(context: click.Context, parameter: click.Parameter, paths: tuple[Path, ...]) -> list[Path]:
    if len(paths) < 2:
        raise click.BadParameter("give two or more corpora")
    return [folder for path in paths if (folder := corpus_folder(context, parameter, path)) is not None]


@click.command()
@click.argument("corpora", metavar="DIR DIR...", nargs=-1, type=A_PATH, callback=_folders)
@folder_option("OUT", "Folder of the new corpus: new or empty.")
@click.option("--title", metavar="TEXT", help="Title of the new corpus; by default the titles of the corpora.")
@click.option(
    "--float32", is_flag=True, help="Store all signals in floating point, if the corpora store them differently."
)
@json_option
def merge(corpora: list[Path], output: Path, title: str | None, float32: bool, as_json: bool) -> None:
    """Join corpora into one.

    They need the same sample rate, length of records and channels. Records keep their samples, labels and splits. Rigs, specimens,
    recordings and pairs are numbered anew, so that machines of different corpora never share a number; two selections of one corpus keep
    their common machines. Corpora that hold the same samples are refused, because a record in training and test set makes every score too
    good. Simulated records can still be replayed.

      raceway merge monday tuesday -o week
      raceway merge simulated measured --float32 --title "Simulated and measured" -o both

    Next: raceway validate OUT, raceway benchmark OUT -o REPORT
    """
    from gen.sharing import merge as merge_corpora

    with progress("merging", "records") as report:
        made = merge_corpora(corpora, output, title=title, float32=float32, progress=report)
    if made.filled:
        notice(
            f"variables that one of the corpora lacks are marked as not known in its records: {', '.join(made.filled)}."
        )
    if as_json:
        facts: dict[str, Any] = {name: getattr(made, name) for name in ("records", "parts", "origins", "filled")}
        show.as_json({"corpus": made.directory, **facts, "signals": made.signals._asdict()})
        return
    size = f"{show.counted(made.records, 'record')} in {show.counted(made.parts, 'part')}"
    show.text(f"{made.directory}: {size}, from {made.origins} corpora.")
    show.text(f"Next: raceway validate {shlex.quote(str(made.directory))}")
