"""Parts of a corpus: drawn, simulated and measured together, labelled and written one by one.

A part is kept if the manifest lists it and its file is the one it lists; every other part is made again, with the same bytes.
"""

import functools
import itertools
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import PartRow, open_part, part_name, sha256, write_part
from gen.families import Records
from gen.labels import part_dataset
from gen.making import ALONE, Crew, MadePart, made_parts
from gen.recipe import Recipe, recipe_hash
from gen.simulation.timeline import timeline

UNIT_SAMPLES = 64e6  # knots of the kernel; about a minute of work


@dataclass(frozen=True)
class Outcome:
    """Result of a task; the records stay on disk."""

    row: PartRow
    kept: bool
    failures: tuple[str, ...]


@functools.cache
def library_versions() -> dict[str, str]:
    """Versions of the libraries that determine the bytes of a part."""
    return {name: version(name) for name in ("raceway", "numpy", "numba", "scipy", "netCDF4", "h5py", "xarray")}


def units(recipe: Recipe, parts: range, workers: int) -> list[range]:
    """``parts`` in units: consecutive parts that one task makes together, as evenly as possible.

    A unit has as many parts as ``UNIT_SAMPLES`` allows, but there are at least as many units as workers, if there are parts enough.
    """
    per_part = recipe.corpus.records_per_part * timeline(recipe).integrated
    wanted = math.ceil(len(parts) * per_part / UNIT_SAMPLES)
    count = min(len(parts), math.ceil(wanted / workers) * workers)
    edges = [parts.start + place * len(parts) // count for place in range(count + 1)]
    return [range(*some) for some in itertools.pairwise(edges)]


def make_parts(
    recipe: Recipe,
    parts: range,
    directory: Path,
    known: Mapping[int, PartRow],
    report: Callable[[int, int], None] = lambda _part, _count: None,
    meanwhile: Callable[[], None] = lambda: None,
    crew: Crew = ALONE,
) -> Iterator[tuple[int, Outcome]]:
    """Write parts, together and each as soon as it is complete; yields number and outcome of each.

    Parameters
    ----------
    recipe : Recipe
        The recipe.
    parts : range
        Numbers of the parts.
    directory : path
        Folder of the corpus.
    known : mapping
        Rows of the manifest by number of the part: a part that is the file listed there is kept.
    report : callable
        Called with the number of a part and the number of its simulated records; the last is not reported before the part is written.
    meanwhile : callable
        Called in this thread now and then while several threads work.
    crew : Crew
        Threads that work on these parts together.
    """
    missing = []
    for part in parts:
        kept = None if part not in known else _kept_part(directory / "parts" / part_name(part), known[part])
        if kept is None:
            missing.append(part)
        else:
            yield part, kept

    def written(made: MadePart) -> tuple[int, Outcome]:
        part = missing[made.place]
        return part, _written(made, recipe, directory / "parts" / part_name(part))

    numbers = [recipe.records_of_part(part) for part in missing]
    yield from made_parts(recipe, numbers, written, lambda place, count: report(missing[place], count), meanwhile, crew)


def _written(made: MadePart, recipe: Recipe, path: Path) -> Outcome:
    """Write one part."""
    dataset, failures = dataset_of(made.records, recipe, made.step_error)
    if not dataset.sizes["record"]:
        return Outcome(PartRow(path.name, 0, 0, ""), kept=False, failures=failures)
    dataset.attrs |= part_attributes(recipe, failures)
    return Outcome(write_part(dataset, path, recipe.corpus.codec), kept=False, failures=failures)


def dataset_of(
    records: Records, recipe: Recipe, step_error: NDArray[np.float64] | None = None
) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Records with their labels in the layout of the corpus (undecoded), and one sentence for each record that is left out."""
    response, scenarios = records.response, records.measured.scenarios
    failures = tuple(response.failures[place] for place in sorted(response.failures))
    dataset = part_dataset(records.measured, scenarios, recipe, response, step_error)
    if failures:
        dataset = dataset.isel(record=[place for place in range(len(scenarios)) if place not in response.failures])
    return dataset, failures


def part_attributes(recipe: Recipe, failures: Sequence[str]) -> dict[str, str]:
    """Global attributes of a part beside those of its records."""
    return {
        "recipe_sha256": recipe_hash(recipe),
        "versions": json.dumps(library_versions()),
        "failures": json.dumps(failures),
    }


def _kept_part(path: Path, known: PartRow) -> Outcome | None:
    """Outcome of the part at ``path`` if it has the size and hash of ``known``; None otherwise."""
    if not path.is_file() or path.stat().st_size != known.bytes or sha256(path) != known.sha256:
        return None
    with open_part(path) as dataset:
        failures = tuple(json.loads(dataset.attrs["failures"]))
    return Outcome(known, kept=True, failures=failures)
