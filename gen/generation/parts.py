"""Parts of a corpus: drawn, simulated and measured together, labelled and written one by one.

A part is kept if its file is whole and names the same recipe, sources and libraries; every other part is made again, with the same bytes.
"""

import functools
import itertools
import json
import math
from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import PartRow, facts_as_attributes, file_facts, part_name, row_of, stored_columns, write_part
from gen.generation.labels import part_dataset
from gen.generation.scheduling import MadePart, made_parts
from gen.generation.sources import sources_sha256
from gen.generation.undetected import MadeRecords
from gen.recipe import Recipe, recipe_hash
from gen.scenarios import settings_of
from gen.simulation.timeline import timeline
from gen.support.processes import in_processes

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


def units(recipe: Recipe, parts: Sequence[int], workers: int) -> list[Sequence[int]]:
    """``parts`` in units: parts that follow each other and that one task makes together, as evenly as possible.

    A unit has as many parts as ``UNIT_SAMPLES`` allows, but there are at least as many units as workers, if there are parts enough.
    """
    per_part = recipe.storage.records_per_part * timeline(settings_of(recipe)).integrated
    wanted = math.ceil(len(parts) * per_part / UNIT_SAMPLES)
    count = min(len(parts), math.ceil(wanted / workers) * workers)
    edges = [place * len(parts) // count for place in range(count + 1)]
    return [parts[first:stop] for first, stop in itertools.pairwise(edges)]


def make_parts(recipe: Recipe, parts: Iterable[int], directory: Path) -> Generator[tuple[int, Outcome]]:
    """Write parts, together and each as soon as it is complete; yields number and outcome of each.

    Parameters
    ----------
    recipe : Recipe
        The recipe.
    parts : iterable of int
        Numbers of the parts, in rising order.
    directory : path
        Folder of the corpus; a part that is in it already is kept.
    """
    missing = []
    for part in parts:
        kept = _kept_part(directory / "parts" / part_name(part), recipe, part)
        if kept is None:
            missing.append(part)
        else:
            yield part, kept

    def written(made: MadePart) -> tuple[int, Outcome]:
        part = missing[made.place]
        return part, write_made(made, recipe, directory / "parts" / part_name(part))

    yield from made_parts(recipe, map(recipe.records_of_part, missing), written)


def write_made(made: MadePart, recipe: Recipe, path: Path) -> Outcome:
    """Write one part."""
    dataset, failures = dataset_of(made.records, made.step_error)
    if not dataset.sizes["record"]:
        return Outcome(PartRow(path.name, 0, 0, ""), kept=False, failures=failures)
    dataset.attrs |= part_attributes(recipe, failures)
    return Outcome(write_part(dataset, path, recipe.storage.codec), kept=False, failures=failures)


def dataset_of(
    records: MadeRecords, step_error: NDArray[np.float64] | None = None
) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Records with their labels in the layout of the corpus (undecoded), and one sentence for each record that is left out."""
    response = records.response
    # a record behind the end of a life has no sentence
    failures = tuple(response.failures[place] for place in sorted(response.failures) if response.failures[place])
    dataset = part_dataset(records.measured, response, step_error)
    if response.failures:
        dataset = dataset.isel(record=[at for at in range(dataset.sizes["record"]) if at not in response.failures])
    return dataset, failures


def parts_in_order(recipe: Recipe, parts: range, workers: int = 1) -> Iterator[tuple[xr.Dataset, tuple[str, ...]]]:
    """Records of parts as from :func:`dataset_of`, in the order of their numbers, made in this process or in several."""
    if workers == 1:
        yield from _in_order(recipe, parts, 0, 1)
        return
    with in_processes(partial(_in_order, recipe, parts), workers) as shares:
        for place in range(len(parts)):
            yield next(shares[place % workers])


def _in_order(recipe: Recipe, parts: range, share: int, shares: int) -> Iterator[tuple[xr.Dataset, tuple[str, ...]]]:
    def finished(made: MadePart) -> tuple[int, tuple[xr.Dataset, tuple[str, ...]]]:
        return made.place, dataset_of(made.records, made.step_error)

    early: dict[int, tuple[xr.Dataset, tuple[str, ...]]] = {}
    following = 0
    for place, part in made_parts(recipe, map(recipe.records_of_part, parts[share::shares]), finished):
        early[place] = part
        while following in early:
            yield early.pop(following)
            following += 1


def part_attributes(recipe: Recipe, failures: Sequence[str]) -> dict[str, str]:
    """Facts of a part, as global attributes beside those of its records."""
    own = {
        "title": recipe.title,
        "history": f"generated by raceway {version('raceway')} from recipe {recipe.name}, seed {recipe.seed}",
    }
    return own | facts_as_attributes(made_by(recipe) | {"failures": failures})


def made_by(recipe: Recipe) -> dict[str, Any]:
    """Facts that decide whether two parts are of one corpus: its recipe, the sources and the libraries that made it."""
    return {
        "recipe": recipe.name,
        "recipe_sha256": recipe_hash(recipe),
        "sources_sha256": sources_sha256(),
        "versions": library_versions(),
    }


def _kept_part(path: Path, recipe: Recipe, part: int) -> Outcome | None:
    """Outcome of a part that is whole and was made from the same recipe with the same sources and libraries; None otherwise."""
    row = row_of(path)
    if row is None:
        return None
    attributes, _ = file_facts(path)
    numbers = stored_columns(path)["recording"]
    expected = recipe.records_of_part(part)
    same = all(attributes.get(name) == text for name, text in facts_as_attributes(made_by(recipe)).items())
    if not same or not (expected.start <= numbers.min() and numbers.max() < expected.stop):
        return None
    return Outcome(row, kept=True, failures=tuple(json.loads(attributes["failures"])))
