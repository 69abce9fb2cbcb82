"""One part of a corpus: drawn, simulated, measured, labelled and written.

A part is kept if the manifest lists it and its file is the one it lists; every other part is made again, with the same bytes.
"""

import functools
import json
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from gen.corpus import PartRow, open_part, part_name, sha256, write_part
from gen.labels import part_dataset
from gen.recipe import Recipe, recipe_hash
from gen.records import made_records
from gen.simulation.simulate import step_errors


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


def record_numbers(recipe: Recipe, part: int) -> range:
    """Numbers of the records of a part."""
    size = recipe.corpus.records_per_part
    return range(part * size, min((part + 1) * size, recipe.n_records))


def make_part(
    recipe: Recipe,
    part: int,
    directory: Path,
    known: PartRow | None = None,
    report: Callable[[int], None] = lambda _: None,
) -> Outcome:
    """Write one part, unless the file is the one that ``known``, its row of the manifest, lists.

    ``report`` is called with the number of simulated records; the last record is not reported before the part is written.
    """
    path = directory / "parts" / part_name(part)
    kept = None if known is None else _kept_part(path, known)
    if kept is not None:
        return kept
    numbers = record_numbers(recipe, part)
    made = made_records(recipe, numbers, lambda done: report(min(done, len(numbers) - 1)))
    response, scenarios = made.response, made.measured.scenarios
    failures = tuple(response.failures[place] for place in sorted(response.failures))
    fine = [place for place in range(len(scenarios)) if place not in response.failures]
    if not fine:
        return Outcome(PartRow(part_name(part), 0, 0, ""), kept=False, failures=failures)
    errors = step_errors(scenarios, recipe, response)
    dataset = part_dataset(made.measured, scenarios, recipe, response, errors)
    if failures:
        dataset = dataset.isel(record=fine)
    dataset.attrs |= {
        "recipe_sha256": recipe_hash(recipe),
        "versions": json.dumps(library_versions()),
        "failures": json.dumps(failures),
    }
    return Outcome(write_part(dataset, path, recipe.corpus.codec), kept=False, failures=failures)


def _kept_part(path: Path, known: PartRow) -> Outcome | None:
    """Outcome of the part at ``path`` if it has the size and hash of ``known``; None otherwise."""
    if not path.is_file() or path.stat().st_size != known.bytes or sha256(path) != known.sha256:
        return None
    with open_part(path) as dataset:
        failures = tuple(json.loads(dataset.attrs["failures"]))
    return Outcome(known, kept=True, failures=failures)
