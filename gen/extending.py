"""Extend a generated corpus by rigs, or by specimens in every rig; no record and no part of it changes.

The new parts are made beside those that exist, from the recipe of the corpus. ``extension.json`` is the manifest of the corpus as it will
be; ``manifest.json`` and ``corpus.nc`` stay as they were until all new parts are there. So the corpus can be read in the meantime, and the
same call completes an interrupted extension.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gen.corpus import (
    DRAWS,
    EXTENSION_NAME,
    JOURNAL_NAME,
    MOST_EXTENSIONS,
    SCHEMA,
    SIGNAL,
    SIMULATED,
    Extension,
    Manifest,
    PartRow,
    extensions_of,
    open_part,
    part_name,
    part_paths,
    read_manifest,
    remove_temporary_files,
    write_manifest,
)
from gen.errors import CorpusError, RecipeError
from gen.generation import Generated, Tally, claimed, client_of, finished, finished_parts
from gen.part_task import library_versions
from gen.progress import Progress
from gen.recipe import Block, Recipe
from gen.replaying import corpus_recipe
from gen.scenarios import draw_scenarios, read_scenario

_NOT_COPIED = {"raceway_format", "complete", "records", "signals", "index", "parts_", "failures", "publication"}
"""Fields of the manifest that are given anew."""


@dataclass(frozen=True)
class Extended(Generated):
    """Result of :func:`extend`; ``kept`` is the number of new parts that were kept from an interrupted call."""

    added: int
    """Number of records that were added."""


@dataclass(frozen=True)
class _Work:
    """An extension to be made or to be completed."""

    recipe: Recipe
    """Of the corpus as it will be."""
    facts: dict[str, Any]
    """Further fields of its manifest."""
    before: list[PartRow]
    """Rows of the parts that exist."""
    failures: tuple[str, ...]
    """Sentences about records of these parts that are left out."""
    known: dict[str, PartRow]
    """Rows of the new parts that may be kept, by name."""


def extend(
    directory: Path | str,
    *,
    rigs: int | None = None,
    specimens: int | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] = lambda _: None,
) -> Extended:
    """Add rigs to a generated corpus, or specimens to each of its rigs, or complete an interrupted extension.

    The numbers of new rigs, specimens, recordings and pairs go on where those of the corpus end. Records that exist keep their bits,
    numbers and splits, and parts that exist keep their bytes.

    Parameters
    ----------
    directory : path
        Folder of a finished corpus that :func:`gen.generate` made.
    rigs, specimens : int
        Number of new rigs, each with as many specimens as the recipe gives a rig, or number of new specimens in each rig: one of the two.
    workers, scheduler, progress, notice : optional
        As of :func:`gen.generate`; progress counts the new records.

    Raises
    ------
    RecipeError
        If not exactly one of the two numbers is given, or a new record cannot be drawn.
    CorpusError
        If the corpus is unfinished or was not generated, another extension of it is unfinished, or a file cannot be written.
    ClusterError
        If the scheduler does not answer or has no workers; or if the cluster is lost.
    """
    asked, directory = _asked(rigs, specimens), Path(directory)
    finished_extensions(directory)  # a folder that is no corpus is not locked
    with client_of(scheduler, workers) as client, claimed(directory):
        work = _work(directory, asked)
        _prepare(directory, work)
        if work.facts["versions"] != library_versions():
            notice(f"the new parts are made with other versions than the old ones: {_newer(work.facts['versions'])}.")
        tally = Tally(work.recipe, progress, work.recipe.blocks[-1].parts)
        outcomes = finished_parts(tally, directory, work.known, workers, client, notice)
        made = finished(directory, outcomes, work.facts, work.before, work.failures)
        (directory / EXTENSION_NAME).unlink()
    added = made.records - sum(row.records for row in work.before)
    return Extended(directory, made.records, made.parts, made.kept, made.failures, made.signals, added)


def _newer(versions: dict[str, str]) -> str:
    """Libraries that have other versions than those that made the corpus."""
    return ", ".join(
        f"{name} {found} instead of {versions.get(name, 'none')}"
        for name, found in library_versions().items()
        if found != versions.get(name)
    )


def new_block(directory: Path | str, *, rigs: int | None = None, specimens: int | None = None) -> Block:
    """Numbers of the rigs, specimens, records and parts that :func:`extend` would add; it raises the same errors."""
    return _work(Path(directory), _asked(rigs, specimens)).recipe.blocks[-1]


def finished_extensions(directory: Path) -> tuple[Extension, ...]:
    """Extensions that a corpus has already.

    Raises
    ------
    CorpusError
        If the corpus cannot be extended, because it was not generated from one recipe or is unfinished.
    """
    manifest = read_manifest(directory)
    if directory.is_file():
        raise CorpusError(f"{directory}: is a packed file; unpack it with raceway unpack, then extend the folder.")
    if (reason := _not_of_one_recipe(manifest)) is not None:
        raise CorpusError(f"{directory}: {reason}.")
    if not manifest.complete:
        raise CorpusError(
            f"{directory}: is unfinished; run the raceway generate command that began it again, then extend it."
        )
    return extensions_of(manifest)


def _not_of_one_recipe(manifest: Manifest) -> str | None:
    """Why no further records can be drawn for a corpus, and what to do; None if they can."""
    if manifest.origins:
        return "was merged from other corpora; extend one of these before they are merged"
    if manifest.selections:
        return "is a selection of another corpus; extend that one, and select from it again"
    if manifest.scenarios is not None:
        return "holds some records of a recipe, or scenarios made by hand; write more of them, and join the two with raceway merge"
    if manifest.overrides is None:
        return (
            "was not generated from a recipe, which further records could be drawn from; make another corpus, and join the two with "
            "raceway merge"
        )
    return None


def _asked(rigs: int | None, specimens: int | None) -> Extension:
    """The one extension that is asked for."""
    given: Extension = {}
    if rigs is not None:
        given["rigs"] = rigs
    if specimens is not None:
        given["specimens"] = specimens
    if len(given) != 1:
        raise RecipeError(
            "an extension adds rigs, or specimens in every rig; give one of the two numbers, rigs or specimens."
        )
    for name, count in given.items():
        if type(count) is not int or not 1 <= count < 2**31:
            raise RecipeError(f"{name}: {count!r} is not allowed; use a whole number from 1 to {2**31 - 1}.")
    return given


def _work(directory: Path, asked: Extension) -> _Work:
    """What is to be done for an extension, with the parts that an interrupted call has left."""
    manifest, done, begun = read_manifest(directory), finished_extensions(directory), _begun(directory, asked)
    wanted = (*done, asked) if begun is None else extensions_of(begun)
    if done not in (wanted, wanted[:-1]) or (begun is not None and begun.recipe_sha256 != manifest.recipe_sha256):
        raise CorpusError(
            f"{directory / EXTENSION_NAME}: is of another corpus; delete it, and extend the corpus again."
        )
    if len(wanted) > MOST_EXTENSIONS:
        raise CorpusError(
            f"{directory}: was extended {MOST_EXTENSIONS} times, which is the limit; generate another corpus, and join the two with "
            f"raceway merge."
        )
    if begun is None:
        part_paths(directory, check="size")  # a corpus with a missing part would be refused when the new parts are made
    recipe, found = corpus_recipe(directory), manifest.parts
    if done != wanted:  # else the last call was killed after it had written the manifest
        _check_rigs(directory, found, recipe)
        recipe = recipe.extended([asked])
        found = begun.parts if begun is not None and begun.versions == library_versions() else []
    names = {part_name(part) for part in recipe.blocks[-1].parts}
    facts = manifest.model_dump(mode="json", by_alias=True, exclude_unset=True, exclude=_NOT_COPIED)
    return _Work(
        recipe,
        facts | {"overrides": {**facts["overrides"], "extensions": wanted}, "publication": manifest.publication},
        [row for row in manifest.parts if row.name not in names],
        (manifest if begun is None else begun).failures,
        {row.name: row for row in found if row.name in names},
    )


def _begun(directory: Path, asked: Extension) -> Manifest | None:
    """Manifest of the extension that an interrupted call began; None if there is none.

    Raises
    ------
    CorpusError
        If it is another extension than the one that is asked for.
    """
    if not (directory / EXTENSION_NAME).exists():
        return None
    begun = read_manifest(directory, EXTENSION_NAME)
    if not extensions_of(begun):
        raise CorpusError(f"{directory / EXTENSION_NAME}: names no extension; delete it, and extend the corpus again.")
    last = extensions_of(begun)[-1]
    if last != asked:
        ((name, count),) = last.items()
        raise CorpusError(
            f"{directory}: an extension by {count} {name} is unfinished; complete it with raceway extend --{name} {count}, or delete "
            f"{EXTENSION_NAME} to give it up."
        )
    return begun


def _check_rigs(directory: Path, rows: list[PartRow], recipe: Recipe) -> None:
    """Refuse a corpus whose machines these libraries do not draw from its recipe: new specimens would be in other machines.

    The last record of the first and of the last part are compared. They are read from the parts, because ``corpus.nc`` may be new already.
    """
    for name in {rows[0].name, rows[-1].name}:
        with open_part(directory / "parts" / name) as part:
            stored = read_scenario(str(part[DRAWS].values[-1]))
            _check_version(directory, part)
        number = stored.record.number
        if draw_scenarios(recipe, number, number + 1)[0].rig != stored.rig:
            raise CorpusError(
                f"{directory}: the installed libraries draw another machine for record {number}; extend the corpus with the versions that "
                f"raceway info shows, or make another corpus, and join the two with raceway merge."
            )


def _check_version(directory: Path, part: xr.Dataset) -> None:
    """Refuse a corpus of an older version: one file cannot hold both its signals and new ones."""
    steps = part[SIGNAL].encoding.get("scale_factor", np.float32(1))
    units = all(part[of.name].attrs.get("units", "1") == of.units for of in (*SCHEMA, *SIMULATED) if of.name in part)
    if steps.dtype != np.float32 or not units:
        raise CorpusError(
            f"{directory}: was made by an older version of raceway, which stored signals and levels in another way; make another corpus, "
            f"and join the two with raceway merge --float32."
        )


def _prepare(directory: Path, work: _Work) -> None:
    """Write the manifest of the unfinished extension, with the parts that may be kept; the journal of an earlier call is removed.

    Before the first call there is a journal only if a call was killed when all else was done; its rows are not of this extension.
    """
    journal = directory / JOURNAL_NAME
    try:
        remove_temporary_files(directory)
        if not work.known:
            journal.unlink(missing_ok=True)
        rows = [*work.before, *work.known.values()]
        facts = work.facts | {"versions": library_versions(), "failures": work.failures}
        write_manifest(directory, rows, complete=False, name=EXTENSION_NAME, **facts)
        journal.unlink(missing_ok=True)
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be written ({error}); copy the corpus to another folder.") from None
