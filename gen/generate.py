"""A recipe becomes a corpus, part by part, on one machine or many.

One task draws, simulates, measures and writes one part and returns its row of the manifest. An interrupted corpus is completed by the
same call: a part that the manifest lists and that is the file it lists is kept, and every other one is made again.
"""

import fcntl
import functools
import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

from gen.cluster import client_of, local_client, run_tasks
from gen.corpus import (
    PartRow,
    SignalCounts,
    check_name,
    data_card,
    open_corpus,
    open_part,
    part_name,
    read_manifest,
    remove_left_behind,
    sha256,
    summed,
    write_durably,
    write_index,
    write_manifest,
    write_part,
    write_text_durably,
)
from gen.errors import CorpusError, RecipeError, SimulationError
from gen.labels import part_dataset
from gen.measurement.measure import compile_mixing, measure
from gen.physics.kernel.batch import input_shape
from gen.recipe import Recipe, find_recipe, read_recipe, recipe_hash
from gen.scenarios import draw_scenarios
from gen.simulation.inputs import kernel_input
from gen.simulation.outline import outlined_input
from gen.simulation.simulate import compile_kernel, simulate, step_errors
from gen.simulation.timeline import timeline

Progress = Callable[[int, int], None]

_HOW = (
    "Simulated by Raceway from `recipe.yaml` (recipe {recipe}): Hertz contact between balls and raceways, shaft, housing and sensor "
    "resonance, classical Runge-Kutta. `raceway replay` makes any record again, bit for bit."
)


@dataclass(frozen=True)
class Generated:
    """What a call to :func:`generate` leaves behind."""

    directory: Path
    records: int
    parts: int
    kept: int
    """Parts that were there already."""
    failures: tuple[str, ...]
    """A sentence for each record that could not be simulated and is left out."""
    signals: SignalCounts
    """Records that cannot be used."""


@dataclass(frozen=True)
class Outcome:
    """What a task returns; the records stay on disk."""

    row: PartRow
    kept: bool
    failures: tuple[str, ...]


def generate(
    recipe: Path | str,
    directory: Path | str,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    seed: int | None = None,
    records: int | None = None,
    progress: Progress | None = None,
) -> Generated:
    """Make a corpus, or complete one.

    Parameters
    ----------
    recipe : path or str
        Recipe file, or name of a recipe that ships with Raceway.
    directory : path
        Folder of the corpus; made if it is not there. Must be empty, or hold the same corpus unfinished or finished.
    workers : int
        Processes on this machine; 1 works in this process.
    scheduler : str, optional
        Address of a dask scheduler whose workers see ``directory`` under the same path; takes the place of ``workers``.
    seed, records : int, optional
        Take the place of the recipe's own.
    progress : callable, optional
        Called with the number of records done and of all records.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe asks for what cannot be.
    CorpusError
        If the folder holds something else, or the disk refuses a file.
    """
    checked = read_recipe(recipe, seed=seed, records=records)
    directory = Path(directory)
    facts = _facts(checked, seed, records)
    with _claimed(directory):
        known = _prepare(directory, Path(find_recipe(recipe)), facts)
        outcomes: dict[int, Outcome] = {}
        done = 0
        with _making(workers, scheduler, checked) as run:
            for part, outcome in run(directory, known):
                outcomes[part] = outcome
                done += min(checked.corpus.records_per_part, checked.n_records - part * checked.corpus.records_per_part)
                rows = [outcomes[number].row for number in sorted(outcomes) if outcomes[number].row.records]
                if len(outcomes) < checked.n_parts:
                    write_manifest(directory, rows, complete=False, **facts)
                if progress is not None:
                    progress(done, checked.n_records)
        return _finished(directory, [outcomes[number] for number in sorted(outcomes)], checked, facts)


def _finished(directory: Path, outcomes: list[Outcome], recipe: Recipe, facts: dict[str, Any]) -> Generated:
    """Write index, manifest and data card over the parts."""
    rows = [outcome.row for outcome in outcomes if outcome.row.records]
    if not rows:
        raise CorpusError(f"{directory}: no record could be simulated; {outcomes[0].failures[0]}")
    failures = tuple(sentence for outcome in outcomes for sentence in outcome.failures)
    signals = summed(row.signals for row in rows)
    write_index(directory, rows)
    write_manifest(directory, rows, complete=True, failures=failures, **facts)
    with open_corpus(directory, check="size") as corpus:
        write_text_durably(data_card(corpus, _HOW.format(recipe=recipe.name), signals), directory / "README.md")
    kept = sum(outcome.kept for outcome in outcomes)
    return Generated(directory, sum(row.records for row in rows), len(rows), kept, failures, signals)


@contextmanager
def _claimed(directory: Path) -> Iterator[None]:
    """Make the folder, and keep every other call out of it."""
    check_name(directory)
    if directory.exists() and not directory.is_dir():
        raise CorpusError(f"{directory}: is a file; give a folder for the corpus.")
    try:
        directory.mkdir(parents=True, exist_ok=True)
        handle = os.open(directory, os.O_RDONLY)
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be written ({error}); choose another folder.") from None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise CorpusError(
            f"{directory}: another raceway generate is at work in it; wait until it ends, or choose another folder."
        ) from None
    except OSError:  # a file system without locks
        pass
    try:
        yield
    finally:
        os.close(handle)


def _prepare(directory: Path, recipe_path: Path, facts: dict[str, Any]) -> dict[str, PartRow]:
    """Make the folder ready, and return the rows of the parts that may be kept.

    The manifest comes first: with it, a corpus of which nothing else is there yet can be told from a folder of something else.
    """
    known: dict[str, PartRow] = {}
    begun = (directory / "manifest.json").exists()
    try:
        for name in ("manifest.json", "corpus.nc", "README.md", "recipe.yaml"):
            remove_left_behind(directory, name)
        manifest = read_manifest(directory) if begun else None
        if manifest is not None and any((directory / "parts").glob("*.nc")):
            if manifest.recipe_sha256 != facts["recipe_sha256"]:
                raise CorpusError(
                    f"{directory}: holds a corpus of another recipe, seed or size; choose another folder."
                )
            if manifest.versions == facts["versions"]:  # else the bytes of new parts may differ from those of old ones
                known = {row.name: row for row in manifest.parts}
        elif manifest is None and any(directory.iterdir()):
            raise CorpusError(f"{directory}: is not empty and holds no corpus; choose another folder.")
        else:
            write_manifest(directory, [], complete=False, **facts)
        if not known:
            write_durably(recipe_path.read_bytes(), directory / "recipe.yaml")
        (directory / "parts").mkdir(exist_ok=True)
        remove_left_behind(directory / "parts", "part-*.nc")
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be written ({error}); choose another folder.") from None
    return known


@functools.cache
def _versions() -> dict[str, str]:
    """Versions of what the bytes of a part depend on."""
    return {name: version(name) for name in ("raceway", "numpy", "numba", "scipy", "netCDF4", "h5py", "xarray")}


def _facts(recipe: Recipe, seed: int | None, records: int | None) -> dict[str, Any]:
    return {
        "title": recipe.title,
        "recipe": recipe.name,
        "recipe_sha256": recipe_hash(recipe),
        "overrides": {"seed": seed, "records": records},
        "versions": _versions(),
    }


Run = Callable[[Path, dict[str, PartRow]], Iterator[tuple[int, Outcome]]]


@contextmanager
def _making(workers: int, scheduler: str | None, recipe: Recipe) -> Iterator[Run]:
    """Something that makes all parts and yields them as they are done: this process, its own cluster, or a given one."""
    if workers < 1:
        raise RecipeError(f"workers: {workers} is not allowed; use 1 or more.")
    parts = range(recipe.n_parts)
    if scheduler is None and workers == 1:
        yield lambda directory, known: map(partial(_numbered_part, recipe, directory), _tasks(parts, known))
        return
    if scheduler is None:
        compile_kernels(recipe)
    with local_client(workers) if scheduler is None else client_of(scheduler) as client:
        yield lambda directory, known: run_tasks(
            client, partial(_numbered_part, recipe, directory.resolve()), _tasks(parts, known)
        )


Task = tuple[int, PartRow | None]
"""Number of a part, and its row of the manifest if it is there already."""


def _tasks(parts: range, known: dict[str, PartRow]) -> Iterator[Task]:
    return ((part, known.get(part_name(part))) for part in parts)


def _numbered_part(recipe: Recipe, directory: Path, task: Task) -> tuple[int, Outcome]:
    part, known = task
    return part, make_part(recipe, part, directory, known)


def compile_kernels(recipe: Recipe) -> None:
    """Compile every kernel a recipe needs into numba's cache on disk, before several processes would do it at once."""
    compile_mixing(draw_scenarios(recipe, 0, 1)[0], recipe)
    done = set()
    for first in range(0, min(recipe.n_records, 4096), recipe.corpus.records_per_part):
        for scenario in draw_scenarios(recipe, first, first + recipe.corpus.records_per_part):
            try:
                shape = input_shape(outlined_input(scenario, timeline(recipe)))
            except SimulationError:  # left out when its part is made
                continue
            if shape not in done:
                done.add(shape)
                compile_kernel(kernel_input(scenario, timeline(recipe)))


def make_part(recipe: Recipe, part: int, directory: Path, known: PartRow | None = None) -> Outcome:
    """Write one part, unless it is there as ``known``, its row of the manifest, says."""
    path = directory / "parts" / part_name(part)
    kept = None if known is None else _kept_part(path, known)
    if kept is not None:
        return kept
    first = part * recipe.corpus.records_per_part
    scenarios = draw_scenarios(recipe, first, first + recipe.corpus.records_per_part)
    response = simulate(scenarios, recipe)
    measured = measure(response.acceleration, scenarios, recipe)
    fine = [place for place in range(len(scenarios)) if place not in response.failures]
    failures = tuple(response.failures[place] for place in sorted(response.failures))
    if not fine:
        return Outcome(PartRow(part_name(part), 0, 0, ""), kept=False, failures=failures)
    errors = step_errors(scenarios, recipe, response)
    dataset = part_dataset(measured, scenarios, recipe, response, errors)
    if failures:
        dataset = dataset.isel(record=fine)
    dataset.attrs |= {
        "recipe_sha256": recipe_hash(recipe),
        "versions": json.dumps(_versions()),
        "failures": json.dumps(failures),
    }
    return Outcome(write_part(dataset, path, recipe.corpus.codec), kept=False, failures=failures)


def _kept_part(path: Path, known: PartRow) -> Outcome | None:
    if not path.is_file() or path.stat().st_size != known.bytes or sha256(path) != known.sha256:
        return None
    with open_part(path) as dataset:
        failures = tuple(json.loads(dataset.attrs["failures"]))
    return Outcome(known, kept=True, failures=failures)
