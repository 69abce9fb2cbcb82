"""Generate a corpus from a recipe, part by part, on one machine or many.

One task makes and writes one part, and returns its row of the manifest. The same call completes an interrupted corpus: a part that is in
the folder is kept if it is whole and was made from the same recipe by the same sources and libraries. A finished corpus that grows stays
what it is until all further parts are there: then its manifest is replaced. The parts of a single file ``NAME.nc`` lie in the folder
``NAME.nc.parts`` until all are there.
"""

import json
import platform
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing, nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from gen.corpus import (
    RECIPE_NAME,
    Manifest,
    PartRow,
    SignalCounts,
    check_place,
    clipping_complaint,
    facts_as_attributes,
    finish_corpus,
    finished,
    is_single_file,
    lock,
    open_corpus,
    read_manifest,
    remove_left_behind_of,
    remove_parts,
    row_of,
    stored_records,
    write_durably,
    write_part,
    writing,
)
from gen.corpus.schema import with_file_codes
from gen.generation.identity import (
    added_classes,
    failures_of,
    made_by,
    origins_of_backgrounds,
    other_code,
    part_file,
)
from gen.generation.target import check_parts, check_same, claim, part_numbers, prepare, remove_other_parts
from gen.recipe import Recipe, find_recipe, read_recipe, recipe_text
from gen.support.display import Shown
from gen.support.errors import ClusterError, CorpusError, RecipeError
from gen.support.executor import Workers, connected, run, too_many
from gen.support.progress import Progress, counter

if TYPE_CHECKING:
    from distributed import Client

_SIMULATOR = "gen.generation.make_part"  # takes a second and a half to load


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
    """One sentence for each record that is left out: it could not be simulated, or its fault cannot be seen."""
    signals: SignalCounts
    """Number of records that cannot be used."""
    clipped: int
    """Number of records with a clipped sample, usable or not."""

    def _heading(self) -> str:
        return f"Corpus {self.path}: {self.records:,} records"

    def _facts(self) -> Mapping[str, object]:
        return {
            "parts": f"{self.parts:,}, of which {self.kept:,} were made before",
            "left out": " ".join(self.failures),
            "clipped": clipping_complaint(self.clipped, self.records) or "",
            "next": f'gen.open_corpus("{self.path}"), features.feature_table("{self.path}")',
            "browse": f"raceway explore {self.path} -o explore.html",
        }


def generate(
    recipe: Path | str | Mapping[str, Any] | Recipe,
    target: Path | str,
    *,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
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
        Number of processes that make parts; 1 is this one.
    scheduler : Client or str, optional
        A dask client, or the address of a dask scheduler, whose workers see the folder under the same path; replaces ``workers``.
    seed, records : int, optional
        Replace the seed and the number of records of the recipe.
    parts : range, optional
        Parts that are made, of a folder; the corpus then has their records, and those of parts that are in the folder. Corpora of other
        parts, such as those of other machines, are joined by :func:`raceway.copy`.
    progress : callable, optional
        Called with the number of records that are on disk and of all records.
    notice : callable, optional
        Called with a sentence when the kernel is compiled, and one about more workers than cores.

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
    if checked.background.recording is not None:
        checked.background.recording.cut(checked)
    if type(workers) is not int or workers < 1:
        raise RecipeError(f"workers: {workers!r} is not allowed; use 1 or more.")
    target = Path(target)
    check_place(target)
    is_file = is_single_file(target)
    # a single file is made from parts that lie beside it until it is whole
    folder = target.with_name(f"{target.name}.parts") if is_file else target
    # what tells whether parts of an earlier call belong to this corpus
    facts = facts_of(checked, {"seed": seed, "records": records})
    if parts is not None:
        check_parts(checked, parts, target)
    elif is_file and target.exists():
        return _finished_before(target, folder, checked, facts)
    # workers of this machine start later, if a part is missing at all
    with nullcontext(workers) if scheduler is None else connected(scheduler, _SIMULATOR) as place, claim(folder):
        if is_file:
            remove_left_behind_of(target)
        named = isinstance(recipe, str | Path)
        # a recipe of a file is kept with its comments
        text = find_recipe(recipe).read_bytes() if named else recipe_text(checked).encode()
        facts = prepare(folder, text, facts, checked)
        every = range(checked.n_parts)
        # parts made on other machines stay
        wanted = every if parts is None else sorted({*parts, *part_numbers(folder)})
        outcomes = _all_parts(checked, wanted, folder, place, progress, notice)
        corpus = _finish(target, folder, text, outcomes, facts)
        if is_file:
            remove_parts(folder, [part_file(checked, part) for part in every])
        else:
            remove_other_parts(folder, checked)
        return corpus


class Outcome(NamedTuple):
    """A part on disk."""

    row: PartRow | None
    """None if all its records are left out."""
    failures: tuple[str, ...]
    kept: bool = False
    """Whether an earlier call made it."""


def facts_of(recipe: Recipe, overrides: dict[str, Any]) -> dict[str, Any]:
    """Fields of the manifest that say where a generated corpus comes from."""
    return {
        "title": recipe.title,
        **made_by(recipe),
        "overrides": overrides,
        "basis": origins_of_backgrounds([recipe]) or None,
    }


def _finished_before(file: Path, folder: Path, recipe: Recipe, facts: dict[str, Any]) -> Generated:
    """Result of a corpus in a single file that an earlier call has finished."""
    manifest = read_manifest(file)
    check_same(file, manifest, facts, recipe)
    with suppress(CorpusError):  # not left by a call that was killed between the last two steps
        left = read_manifest(folder)
        if not left.complete and left.recipe_sha256 == manifest.recipe_sha256:
            with lock(folder):
                remove_parts(folder, [part_file(recipe, part) for part in range(recipe.n_parts)])
    return _generated(file, manifest, recipe.n_parts, recipe.n_parts)


def _generated(path: Path, manifest: Manifest, parts: int, kept: int) -> Generated:
    """Result of a finished corpus, of which so many parts were kept."""
    with open_corpus(path, check="size") as corpus:
        clipped = int((corpus["clipped"].values > 0).sum())
    return Generated(path, manifest.records, parts, kept, manifest.failures, manifest.signals, clipped)


def _all_parts(
    recipe: Recipe,
    parts: Sequence[int],
    folder: Path,
    workers: Workers,
    progress: Progress | None,
    notice: Callable[[str], None],
) -> list[Outcome]:
    """Make those of the parts that are missing; outcomes of all of them in their order."""
    counts = {part: len(recipe.records_of_part(part)) for part in parts}
    report = counter(progress, sum(counts.values()))
    outcomes = dict[int, Outcome]()
    # whole parts of an earlier call are kept
    for part in parts:
        if (kept := _kept(recipe, folder, part)) is not None:
            outcomes[part] = kept
            report(counts[part])
    if missing := [part for part in parts if part not in outcomes]:
        here = isinstance(workers, int)
        if here and (sentence := too_many(workers)) is not None:
            notice(sentence)
        task = partial(_write, recipe, folder.resolve(), made_by(recipe))
        with connected(min(workers, len(missing)) if here else workers, _SIMULATOR) as place:
            if here:
                from gen.generation.compilation import compile_kernels  # loaded while the processes start

                compile_kernels(recipe, notice)
            with closing(run(task, missing, place)) as results:
                for part, outcome in zip(missing, results, strict=True):
                    outcomes[part] = outcome
                    report(counts[part])
    return [outcomes[part] for part in parts]


def _write(recipe: Recipe, folder: Path, asked: Mapping[str, Any], part: int) -> Outcome:
    """Make and write one part; dask may repeat the task, which then writes the same bytes.

    Raises
    ------
    ClusterError
        If this process has other sources or libraries than the one that asks for the part.
    """
    if other := other_code(asked, made_by(recipe)):
        raise ClusterError(
            f"worker {platform.node()}: has {other[1]}, and this process {other[0]}; install the same versions on every worker."
        )
    from gen.generation.make_part import make_part  # the simulator, which takes a second and a half to load

    dataset = make_part(recipe, recipe.records_of_part(part))
    path = folder / "parts" / part_file(recipe, part)
    dataset = with_file_codes(dataset, added_classes(recipe))
    row = write_part(dataset, path, recipe.storage.codec) if dataset.sizes["record"] else None
    return Outcome(row, failures_of(dataset))


def _kept(recipe: Recipe, folder: Path, part: int) -> Outcome | None:
    """A part that is whole and was made from the same recipe with the same sources and libraries; None otherwise."""
    path = folder / "parts" / part_file(recipe, part)
    row = row_of(path)
    if row is None:
        return None
    with stored_records([path]) as records:
        attributes, numbers = records.attrs, records["recording"].values
    # a part with the name of this one may be another one
    expected = recipe.records_of_part(part)
    # the same recipe, sources and libraries give the same bytes
    same = all(attributes.get(name) == text for name, text in facts_as_attributes(made_by(recipe)).items())
    if not same or not (expected.start <= numbers.min() and numbers.max() < expected.stop):
        return None
    return Outcome(row, tuple(json.loads(attributes["failures"])), kept=True)


def _finish(target: Path, folder: Path, text: bytes, outcomes: list[Outcome], facts: dict[str, Any]) -> Generated:
    """Write recipe, index and manifest of the finished parts, or a single file of them."""
    rows = [outcome.row for outcome in outcomes if outcome.row is not None]
    if not rows:
        raise CorpusError(f"{target}: no record could be simulated; {outcomes[0].failures[0]}")
    failures = tuple(sentence for outcome in outcomes for sentence in outcome.failures)
    manifest = None
    with suppress(CorpusError):  # a corpus that has all its parts stays as it is, with its card
        manifest = finished(folder)
    if manifest is None or manifest.parts != tuple(rows):
        # recipe first, manifest last: a folder without a manifest of finished parts is unfinished
        with writing(folder):
            write_durably(text, folder / RECIPE_NAME)
        manifest = finish_corpus(folder, rows, None if target == folder else target, **facts, failures=failures)
    return _generated(target, manifest, len(rows), sum(outcome.kept for outcome in outcomes))
