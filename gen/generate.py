"""A recipe becomes a corpus, part by part, on one machine or many.

One task draws, simulates, measures and writes one part and returns its row of the manifest. A part that is there and whole is kept, so
that a task may run twice and an interrupted corpus is completed by the same call. At most a few parts per worker are under way at a
time: memory does not grow with the corpus.
"""

import functools
import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from itertools import islice
from pathlib import Path
from typing import Any

from distributed import Client, LocalCluster, as_completed

from gen.corpus import (
    PartRow,
    SignalCounts,
    data_card,
    describe_part,
    open_corpus,
    open_part,
    part_name,
    read_manifest,
    sha256,
    summed,
    write_index,
    write_manifest,
    write_part,
    write_text_durably,
)  # fmt: skip
from gen.errors import CorpusError, RacewayError, RecipeError, SimulationError
from gen.labels import part_dataset
from gen.measure import compile_mixing, measure
from gen.outline import outlined_record
from gen.physics.batch import record_shape
from gen.recipe import Recipe, find_recipe, read_recipe, recipe_hash
from gen.scenarios import draw_scenarios
from gen.simulate import compile_kernel, kernel_record, simulate, step_errors

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
    known = _prepare(directory, Path(find_recipe(recipe)), facts)
    outcomes: dict[int, Outcome] = {}
    counts = [min((part + 1) * checked.corpus.records_per_part, checked.n_records) for part in range(checked.n_parts)]
    done = 0
    with _map(workers, scheduler, checked) as run:
        for part, outcome in run(range(checked.n_parts), directory, known):
            outcomes[part] = outcome
            done += counts[part] - (counts[part - 1] if part else 0)
            rows = [outcomes[number].row for number in sorted(outcomes)]
            if len(outcomes) < checked.n_parts:
                write_manifest(directory, rows, complete=False, **facts)
            if progress is not None:
                progress(done, checked.n_records)
    ordered = [outcomes[number] for number in sorted(outcomes)]
    rows = [outcome.row for outcome in ordered if outcome.row.records]
    if not rows:
        raise CorpusError(f"{directory}: no record could be simulated; {ordered[0].failures[0]}")
    failures = tuple(sentence for outcome in ordered for sentence in outcome.failures)
    signals = summed(row.signals for row in rows)
    write_index(directory, rows)
    write_manifest(directory, rows, complete=True, failures=list(failures), **facts)
    with open_corpus(directory, check="size") as corpus:
        write_text_durably(data_card(corpus, _HOW.format(recipe=checked.name), signals), directory / "README.md")
    kept = sum(outcome.kept for outcome in ordered)
    return Generated(directory, sum(row.records for row in rows), len(rows), kept, failures, signals)


def _prepare(directory: Path, recipe_path: Path, facts: dict[str, Any]) -> dict[str, str]:
    """Make the folder ready, and return the hashes of the parts it already has.

    The manifest comes first: with it, a corpus of which nothing else is there yet can be told from a folder of something else.
    """
    known: dict[str, str] = {}
    begun = (directory / "manifest.json").exists()
    try:
        if directory.exists() and not directory.is_dir():
            raise CorpusError(f"{directory}: is a file; give a folder for the corpus.")
        manifest = read_manifest(directory) if begun else {}
        if begun and any((directory / "parts").glob("*.nc")):
            if manifest.get("recipe_sha256") != facts["recipe_sha256"]:
                raise CorpusError(
                    f"{directory}: holds a corpus of another recipe, seed or size; choose another folder."
                )
            known = {row.name: row.sha256 for row in manifest["parts"]}
        elif not begun and directory.exists() and any(directory.iterdir()):
            raise CorpusError(f"{directory}: is not empty and holds no corpus; choose another folder.")
        else:
            directory.mkdir(parents=True, exist_ok=True)
            write_manifest(directory, [], complete=False, **facts)
            shutil.copyfile(recipe_path, directory / "recipe.yaml")
        if not (directory / "recipe.yaml").exists():
            shutil.copyfile(recipe_path, directory / "recipe.yaml")
        (directory / "parts").mkdir(exist_ok=True)
        for left_behind in (directory / "parts").glob(".*.tmp"):  # by a process that was killed while it wrote
            left_behind.unlink()
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


Run = Callable[[range, Path, dict[str, str]], Iterator[tuple[int, Outcome]]]


@contextmanager
def _map(workers: int, scheduler: str | None, recipe: Recipe) -> Iterator[Run]:
    """Something that makes parts and yields them as they are done: this process, its own cluster, or a given one."""
    if workers < 1:
        raise RecipeError(f"workers: {workers} is not allowed; use 1 or more.")
    if scheduler is None and workers == 1:
        yield lambda parts, directory, known: (
            (part, make_part(recipe, part, directory, known.get(part_name(part)))) for part in parts
        )
        return
    if scheduler is None:
        compile_kernels(recipe)
        with (
            LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster,
            Client(cluster) as client,
        ):
            yield lambda parts, directory, known: _on_cluster(client, recipe, parts, directory, known)
        return
    try:
        # asked by a client that is not the default one: if nobody answers, that would stay, and xarray ask it for locks
        Client(scheduler, timeout="10s", set_as_default=False).close()
    except (OSError, ValueError, TimeoutError) as error:
        reason = " ".join(str(error).split())
        raise RecipeError(
            f"scheduler {scheduler}: does not answer ({reason}); give the address dask scheduler printed."
        ) from None
    with Client(scheduler) as client:
        try:
            client.wait_for_workers(1, timeout=10)
        except TimeoutError:
            raise RecipeError(
                f"scheduler {scheduler}: has no workers; start some with dask worker {scheduler}."
            ) from None
        yield lambda parts, directory, known: _on_cluster(client, recipe, parts, directory.resolve(), known)


def _on_cluster(
    client: Client, recipe: Recipe, parts: range, directory: Path, known: dict[str, str]
) -> Iterator[tuple[int, Outcome]]:
    waiting = iter(parts)
    directory = directory.resolve()

    def submit(part: int) -> Any:
        return client.submit(_numbered_part, recipe, part, directory, known.get(part_name(part)), pure=False)

    threads: Any = client.nthreads()
    width = 2 * max(sum(threads.values()), 1)
    running = as_completed([submit(part) for part in islice(waiting, width)])
    for future in running:
        yield future.result()
        following = next(waiting, None)
        if following is not None:
            running.add(submit(following))


def _numbered_part(recipe: Recipe, part: int, directory: Path, known: str | None) -> tuple[int, Outcome]:
    return part, make_part(recipe, part, directory, known)


def compile_kernels(recipe: Recipe) -> None:
    """Compile every kernel a recipe needs into numba's cache on disk, before several processes would do it at once."""
    compile_mixing(draw_scenarios(recipe, 0, 1)[0], recipe)
    done = set()
    for first in range(0, min(recipe.n_records, 4096), recipe.corpus.records_per_part):
        for scenario in draw_scenarios(recipe, first, first + recipe.corpus.records_per_part):
            try:
                shape = record_shape(outlined_record(scenario, recipe))
            except SimulationError:  # left out when its part is made
                continue
            if shape not in done:
                done.add(shape)
                compile_kernel(kernel_record(scenario, recipe))


def make_part(recipe: Recipe, part: int, directory: Path, known: str | None = None) -> Outcome:
    """Write one part, unless it is there and whole; ``known`` is the hash the manifest has of it."""
    path = directory / "parts" / part_name(part)
    kept = _whole_part(path, recipe, known)
    if kept is not None:
        return kept
    first = part * recipe.corpus.records_per_part
    scenarios = draw_scenarios(recipe, first, first + recipe.corpus.records_per_part)
    response = simulate(scenarios, recipe)
    measured = measure(response, scenarios, recipe)
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


def _whole_part(path: Path, recipe: Recipe, known: str | None) -> Outcome | None:
    if not path.is_file() or (known is not None and sha256(path) != known):
        return None
    try:
        with open_part(path) as dataset:
            if dataset.attrs.get("recipe_sha256") != recipe_hash(recipe):
                return None
            if dataset.attrs.get("versions") != json.dumps(_versions()):
                return None
            failures = tuple(json.loads(dataset.attrs["failures"]))
        return Outcome(describe_part(path), kept=True, failures=failures)
    except (RacewayError, KeyError, ValueError):
        return None
