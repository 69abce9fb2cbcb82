"""The command that adds rigs or specimens to a generated corpus."""

import shlex
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.options import Team, corpus_argument, json_option, worker_options
from raceway.console.progress import notice, progress
from raceway.console.signals import if_interrupted

if TYPE_CHECKING:
    from gen.extending import Extended


@click.command()
@corpus_argument
@click.option(
    "--specimens", type=click.IntRange(min=1), metavar="N", help="Add N specimens to every rig of the corpus."
)
@click.option("--rigs", type=click.IntRange(min=1), metavar="N", help="Add N rigs, each with its specimens.")
@worker_options
@json_option
def extend(
    corpus: Path,
    specimens: int | None,
    rigs: int | None,
    workers: int | None,
    scheduler: str | None,
    as_json: bool,
) -> int:
    """Add specimens or rigs to the generated corpus in DIR.

    The new records are drawn from the recipe of the corpus. Old records keep their bits, numbers and splits, and old parts keep their
    bytes. A new rig has as many specimens as the recipe gives a rig, and a specimen as many records. Until the new parts are made, DIR
    can be read as it was. If the command is interrupted, finished new parts are kept, and the same command completes the extension.

    Exits with 1 if more than 1 % of the records of the corpus cannot be used, as generate does.

      raceway extend corpus --specimens 2
      raceway extend corpus --rigs 4 --workers 8

    Next: raceway info DIR, raceway validate DIR
    """
    from gen.corpus import complaint
    from gen.extending import extend as extend_corpus
    from gen.extending import new_block
    from gen.workers import share_one_heap

    share_one_heap()
    added = {"rigs": rigs, "specimens": specimens}
    block = new_block(corpus, **added)
    team = Team(workers, scheduler).options(len(block.records))
    start = time.monotonic()
    with if_interrupted(partial(_kept, corpus, len(block.parts))), progress("extending", "records") as report:
        made = extend_corpus(corpus, **added, **team, progress=report, notice=notice)
    useless = complaint(made.signals, made.records)
    if useless is not None:
        notice(useless)
    if as_json:
        facts = {name: getattr(made, name) for name in ("records", "added", "parts", "kept", "failures")}
        seconds = round(time.monotonic() - start, 3)
        show.as_json({"corpus": made.directory, **facts, "signals": made.signals._asdict(), "seconds": seconds})
    else:
        _show_extended(made)
    return DONE if useless is None else FOUND_WANTING


def _show_extended(made: "Extended") -> None:
    kept = f"; {made.kept} of the new parts kept from before" if made.kept else ""
    failed = f"; {len(made.failures):,} could not be simulated and are left out" if made.failures else ""
    size = f"{show.counted(made.records, 'record')} in {show.counted(made.parts, 'part')}"
    show.text(f"{made.directory}: {size}, {made.added:,} of the records are new{kept}{failed}.")
    show.text(f"Next: raceway info {shlex.quote(str(made.directory))}")


def _kept(corpus: Path, n_parts: int) -> str:
    """Remove the unfinished files of the workers, and return a sentence about the new parts that are kept."""
    from gen.corpus import EXTENSION_NAME, read_manifest, remove_left_behind
    from gen.errors import RacewayError

    remove_left_behind(corpus / "parts", "part-*.nc")
    try:
        kept = len(read_manifest(corpus, EXTENSION_NAME).parts) - len(read_manifest(corpus).parts)
    except RacewayError:  # before the first part
        kept = 0
    of_all = f"{max(kept, 0)} of {show.counted(n_parts, 'new part')}"
    return f"interrupted; {of_all} kept in {corpus}, which can be read as before; the same command completes the extension."
