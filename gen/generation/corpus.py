"""Generate a corpus from a recipe, part by part, on one machine or many.

One task draws, simulates, measures and writes some parts and returns their rows of the manifest. The same call completes an interrupted
corpus: a part that is in the folder is kept if it is whole and was made from the same recipe by the same sources and libraries. The parts
of a single file ``NAME.nc`` lie in the folder ``NAME.nc.parts`` until all are there.
"""

import platform
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from gen.corpus import (
    MANIFEST_NAME,
    RECIPE_NAME,
    SignalCounts,
    check_place,
    corpus_files,
    facts_of_parts,
    file_facts,
    finish_corpus,
    finish_file,
    is_single_file,
    lock,
    part_name,
    read_manifest,
    remove_left_behind_of,
    remove_parts,
    remove_temporary_files,
    row_of,
    stored_columns,
    write_durably,
    write_manifest,
    writing,
)
from gen.generation.compilation import compile_kernels, missing_kernels
from gen.generation.forecast import expected_work, forecast_in_words, leave_rate, seconds_of
from gen.generation.parts import Outcome, made_by, make_parts, units
from gen.generation.sources import sources_sha256
from gen.generation.step_checks import CHECKED_PARTS
from gen.recipe import Recipe, find_recipe, read_recipe, recipe_text
from gen.support.errors import ClusterError, CorpusError, RecipeError
from gen.support.processes import as_they_come
from gen.support.progress import Progress, counter
from gen.support.shown import Shown
from gen.support.workers import cores, run, too_many

if TYPE_CHECKING:
    from distributed import Client

    from gen.corpus import Manifest


@dataclass(frozen=True, repr=False)
class Generated(Shown):
    """Result of :func:`generate`."""

    path: Path
    """Folder or single file of the corpus."""
    records: int
    parts: int
    kept: int
    """Number of parts that were kept from an earlier call."""
    failures: tuple[str, ...]
    """One sentence for each record that is left out because it could not be simulated."""
    signals: SignalCounts
    """Number of records that cannot be used."""

    def _heading(self) -> str:
        return f"Corpus {self.path}: {self.records:,} records"

    def _facts(self) -> Mapping[str, object]:
        return {
            "parts": f"{self.parts:,}, of which {self.kept:,} were made before",
            "left out": " ".join(self.failures),
            "next": f'gen.open_corpus("{self.path}"), features.feature_table("{self.path}")',
            "browse": f"raceway explore {self.path} -o explore.html",
        }


def generate(
    recipe: Path | str | Mapping[str, Any] | Recipe,
    target: Path | str,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    seed: int | None = None,
    records: int | None = None,
    parts: range | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] = lambda _: None,
) -> Generated:
    """Generate a corpus, or complete an interrupted one.

    Parameters
    ----------
    recipe : path, str, mapping or Recipe
        Recipe file, name of a recipe that ships with Raceway, the keys of a recipe, or a recipe that has been read.
    target : path
        Single file of the corpus if the name ends in ``.nc``, else its folder; created if it does not exist. It may hold the same corpus,
        unfinished or finished; a folder may also hold fewer of its records, and then the rest is made.
    workers : int
        Number of processes that make parts, this one among them. A script that starts several needs ``if __name__ == "__main__":``.
    scheduler : str, optional
        Address of a dask scheduler whose workers see the folder under the same path; replaces ``workers``.
    seed, records : int, optional
        Replace the seed and the number of records of the recipe.
    parts : range, optional
        Parts that are made, of a folder; the corpus then has their records, and those of parts that are in the folder. Corpora of other
        parts, such as those of other machines, are joined by :func:`gen.copy`.
    progress : callable, optional
        Called with the number of records that are on disk and of all records; from a cluster in another thread.
    notice : callable, optional
        Called with a sentence that says how long it takes, one when a kernel is about to be compiled, and one about more workers than
        cores.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    CorpusError
        If the target holds something else, or a corpus that other sources of Raceway began, or a file cannot be written.
    ClusterError
        If the scheduler does not answer or has no workers, before anything is written; or if the cluster is lost.
    """
    checked = read_recipe(recipe, seed=seed, records=records)
    target = Path(target)
    check_place(target)
    folder = target.with_name(f"{target.name}.parts") if is_single_file(target) else target
    facts = facts_of(checked, {"seed": seed, "records": records})
    if parts is not None:
        _check_parts(checked, parts, target)
    elif is_single_file(target) and target.exists():
        return _finished_before(target, folder, checked, facts)
    with client_of(scheduler, workers) as client, _claim(folder):
        if folder is not target:
            remove_left_behind_of(target)
        named = isinstance(recipe, str | Path)
        text = find_recipe(recipe).read_bytes() if named else recipe_text(checked).encode()
        _prepare(folder, text, facts, checked, range(checked.n_parts) if parts is None else parts)
        wanted = range(checked.n_parts) if parts is None else _with_those_there(checked, parts, folder)
        outcomes = _all_parts(checked, wanted, folder, workers, client, progress, notice)
        corpus = _finish(target, folder, outcomes, facts)
        if folder is not target:
            remove_parts(folder, map(part_name, range(checked.n_parts)))
        return corpus


def facts_of(recipe: Recipe, overrides: dict[str, Any]) -> dict[str, Any]:
    """Fields of the manifest that say where a generated corpus comes from."""
    return {
        "title": recipe.title,
        **made_by(recipe),
        "overrides": overrides,
        "publication": recipe.publication,
    }


def _check_parts(recipe: Recipe, parts: range, target: Path) -> None:
    last = recipe.n_parts - 1
    if is_single_file(target):
        raise CorpusError(f"{target}: is one file, which has all parts; give a folder for some of them.")
    if not parts or parts.step != 1 or parts.start < 0 or parts[-1] > last:
        asked = f"{parts.start}-{parts.stop - 1}"
        raise RecipeError(f"parts: {asked} is not allowed; {recipe.name} has the parts 0-{last}, give a range of them.")


def _with_those_there(recipe: Recipe, parts: range, folder: Path) -> list[int]:
    """Numbers of the parts, and of those that are in the folder already."""
    return sorted({*parts, *_there(folder, range(recipe.n_parts))})


def _there(folder: Path, parts: Sequence[int]) -> list[int]:
    """Those of the parts that have a file, whole or not."""
    return [part for part in parts if (folder / "parts" / part_name(part)).exists()]


def _finished_before(file: Path, folder: Path, recipe: Recipe, facts: dict[str, Any]) -> Generated:
    """Result of a corpus in a single file that an earlier call has finished."""
    corpus_files(file)
    manifest = read_manifest(file)
    _check_same(file, manifest, facts)
    held = manifest.records + len(manifest.failures)
    if recipe.life is not None:  # every bearing has a first snapshot
        last = int(stored_columns(file)["recording"].max())
        held = recipe.records_of(recipe.specimen_of(last)).stop if last < recipe.n_records else last
    if held != recipe.n_records:
        raise CorpusError(
            f"{file}: holds {manifest.records} records and not {recipe.n_records}; a corpus grows in a folder: choose another name."
        )
    with suppress(CorpusError):  # not left by a call that was killed between the last two steps
        left = read_manifest(folder)
        if not left.complete and left.recipe_sha256 == manifest.recipe_sha256:
            with lock(folder):
                remove_parts(folder, map(part_name, range(recipe.n_parts)))
    return Generated(file, manifest.records, recipe.n_parts, recipe.n_parts, manifest.failures, manifest.signals)


def _all_parts(
    recipe: Recipe,
    parts: Sequence[int],
    folder: Path,
    workers: int,
    client: "Client | None",
    progress: Progress | None,
    notice: Callable[[str], None],
) -> list[Outcome]:
    """Make those of the parts that are missing; outcomes of all of them in their order."""
    work, workers = 0.0, min(workers, len(parts))
    at_once = min(workers, cores())
    if client is None and (sentence := too_many(workers)) is not None:
        notice(sentence)
    if client is None and len(_there(folder, parts)) < len(parts):
        missing, work = missing_kernels(recipe), expected_work(recipe)
        notice(forecast_in_words(len(missing), recipe.n_records * at_once / seconds_of(work)))
        compile_kernels(recipe, missing, notice)
    outcomes: dict[int, Outcome] = {}
    start, done = time.monotonic(), _tally(recipe, parts, progress)
    with closing(_made(recipe, parts, folder, workers, client, done)) as made:
        for part, outcome in made:
            outcomes[part] = outcome
            done(part)
    if work and len(parts) == recipe.n_parts and not any(outcome.kept for outcome in outcomes.values()):
        leave_rate(work, at_once * (time.monotonic() - start))
    return [outcomes[number] for number in sorted(outcomes)]


def _finish(target: Path, folder: Path, outcomes: list[Outcome], facts: dict[str, Any]) -> Generated:
    """Write index, manifest and data card of the finished parts, or a single file of them."""
    rows = [outcome.row for outcome in outcomes if outcome.row.records]
    if not rows:
        raise CorpusError(f"{target}: no record could be simulated; {outcomes[0].failures[0]}")
    failures = tuple(sentence for outcome in outcomes for sentence in outcome.failures)
    facts = facts | {"publication": facts["publication"].dated(), "failures": failures}
    whole = target == folder
    signals = finish_corpus(folder, rows, **facts) if whole else finish_file(folder, rows, target, **facts)
    kept = sum(outcome.kept for outcome in outcomes)
    return Generated(target, sum(row.records for row in rows), len(rows), kept, failures, signals)


@contextmanager
def _claim(folder: Path) -> Iterator[None]:
    """Create the folder and lock it against other calls."""
    if folder.exists() and not folder.is_dir():
        raise CorpusError(f"{folder}: is a file; give a folder, or a file that ends in .nc, for the corpus.")
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with lock(folder):
        yield


def _prepare(folder: Path, text: bytes, facts: dict[str, Any], recipe: Recipe, parts: range) -> None:
    """Check what the folder holds, and write the manifest of an unfinished corpus, unless it has all parts.

    The manifest is written first: it tells a corpus without any part from a folder that holds something else.
    """
    again, finished = set[int](), False
    with writing(folder):
        remove_temporary_files(folder)
        if (folder / MANIFEST_NAME).exists():
            manifest = read_manifest(folder)
            _check_same(folder, manifest, facts)
            _check_generated(folder, manifest)
            again = _parts_again(folder, manifest, recipe)
            if not facts["publication"].stored:
                facts["publication"] = manifest.publication  # given after the corpus was made
            finished = (
                manifest.complete and not again and {*map(part_name, parts)} <= {row.name for row in manifest.parts}
            )
        elif any(folder.iterdir()):
            raise CorpusError(f"{folder}: is not empty and holds no corpus; choose another folder.")
        if not finished:
            write_manifest(folder, facts_of_parts([], facts, complete=False))
        write_durably(text, folder / RECIPE_NAME)
        (folder / "parts").mkdir(exist_ok=True)
        for part in again:
            (folder / "parts" / part_name(part)).unlink(missing_ok=True)


def _parts_again(folder: Path, manifest: "Manifest", recipe: Recipe) -> set[int]:
    """Parts that a larger corpus makes again: a last part that is not full, and one in which too few steps were checked."""
    overrides = {} if manifest.overrides is None else dict(manifest.overrides)
    begun = folder / RECIPE_NAME  # not there if a call was killed before its first part
    before = read_recipe(begun, **overrides).n_records if begun.exists() else recipe.n_records
    if recipe.n_records < before:
        raise CorpusError(
            f"{folder}: holds a corpus of {before} records and not {recipe.n_records}; a corpus grows and does not shrink: choose another "
            "name."
        )
    if recipe.n_records == before:
        return set()
    last, rest = divmod(before, recipe.storage.records_per_part)
    return {(last - (rest == 0)) // CHECKED_PARTS * CHECKED_PARTS, *([last] if rest else [])}


def _check_same(place: Path, manifest: "Manifest", facts: dict[str, Any]) -> None:
    """Refuse to complete a corpus of another recipe, or one that other sources or libraries began: its records would not go together."""
    if manifest.recipe_sha256 is None:
        raise CorpusError(
            f"{place}: holds a corpus that was not generated from a recipe as a whole; choose another name."
        )
    if manifest.recipe_sha256 != facts["recipe_sha256"]:
        raise CorpusError(f"{place}: holds a corpus of another recipe or seed; choose another name.")
    began = manifest.versions | {"sources": (manifest.sources_sha256 or "unknown")[:12]}
    now = facts["versions"] | {"sources": facts["sources_sha256"][:12]}
    other = [name for name in now if began.get(name) != now[name]]
    if other:
        was, installed = (
            ", ".join(f"{name} {versions.get(name, 'none')}" for name in other) for versions in (began, now)
        )
        raise CorpusError(
            f"{place}: was begun with {was}; {installed} is installed and can give other samples: install the former to "
            "complete it, or choose another name."
        )


def _check_generated(folder: Path, manifest: "Manifest") -> None:
    """Refuse a copy: its parts have other records than those that are generated, and would be made again."""
    whole = next(filter(row_of, (folder / "parts" / row.name for row in manifest.parts)), None)
    if whole is not None and "recipe_sha256" not in file_facts(whole)[0]:
        raise CorpusError(f"{folder}: holds a copy of a corpus, which is not generated again; choose another name.")


def _tally(recipe: Recipe, parts: Sequence[int], progress: Progress | None) -> Callable[[int], None]:
    """What takes the number of a part that is on disk, and tells ``progress`` the number of records on disk; of repeated parts once."""
    sizes = {part: len(recipe.records_of_part(part)) for part in parts}
    count = counter(progress, sum(sizes.values()))
    return lambda part: count(sizes.pop(part, 0))


def client_of(scheduler: str | None, workers: int) -> "AbstractContextManager[Client | None]":
    """Client of the scheduler at an address; None if no address is given, but a number of workers that must be 1 or more."""
    if workers < 1:
        raise RecipeError(f"workers: {workers} is not allowed; use 1 or more.")
    if scheduler is None:
        return nullcontext()
    from gen.support import cluster  # distributed takes 0.3 s to load, and work in this process does not need it

    return cluster.client_of(scheduler)


def _made(
    recipe: Recipe,
    parts: Sequence[int],
    folder: Path,
    workers: int,
    client: "Client | None",
    report: Callable[[int], None],
) -> Generator[tuple[int, Outcome]]:
    """Number and outcome of every part in the order in which they finish: from this process, from several, or from a cluster.

    ``report`` is called with a part that a worker of the cluster has written; its outcome comes with that of other parts.
    """
    if client is not None:
        threads: list[int] = list(cast("Any", client).nthreads().values())
        task = partial(_unit, recipe, folder.resolve(), sources_sha256())
        return run(task, units(recipe, parts, max(sum(threads), 1)), scheduler=client, report=report)
    if workers == 1:
        return make_parts(recipe, parts, folder)
    there = _there(folder, parts)
    return as_they_come(partial(_share, recipe, folder.resolve(), there, sorted({*parts} - {*there})), workers)


def _share(
    recipe: Recipe, folder: Path, there: list[int], missing: list[int], share: int, shares: int
) -> Iterator[tuple[int, Outcome]]:
    """Make the parts of one process: missing ones that follow each other, and of those that seem to be there as many as the others."""
    first, stop = (len(missing) * edge // shares for edge in (share, share + 1))
    return make_parts(recipe, sorted(there[share::shares] + missing[first:stop]), folder)


def _unit(
    recipe: Recipe, folder: Path, sources: str, report: Callable[[int], None], parts: Sequence[int]
) -> Iterator[tuple[int, Outcome]]:
    """Make some parts on a worker of a cluster, if it has the sources of the process that asks for them."""
    if sources_sha256() != sources:
        raise ClusterError(
            f"worker {platform.node()}: has other sources of raceway ({sources_sha256()[:12]}) than this process ({sources[:12]}); install "
            f"the same version on every worker."
        )
    for part, outcome in make_parts(recipe, parts, folder):
        report(part)
        yield part, outcome
