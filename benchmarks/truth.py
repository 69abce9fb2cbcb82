"""CPU time of a record whose fault is judged, compared with a record that is simulated once and not judged.

A part of ``domain_randomised`` is drawn, simulated, measured, labelled and written in this process, by the same code as a worker's.
"""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from benchmarks.pairs import Line, interleaved, row
from gen.corpus import write_part
from gen.generation.make_part import make_part
from gen.recipe import Recipe, read_recipe

SETTINGS = {
    "none": {"twins": False, "undetected": "keep"},
    "full": {"twins": True, "undetected": "keep"},
    "redraw": {"twins": True, "undetected": "redraw"},
}


def rows(pairs: int = 2, records: int = 320, recipe: Path | str = "domain_randomised") -> Iterator[Line]:
    """Lines of the table."""
    checked = read_recipe(recipe, records=records)
    recipes = {
        name: checked.model_copy(update={"truth": checked.truth.model_copy(update=keys)})
        for name, keys in SETTINGS.items()
    }
    for changed in recipes.values():
        cpu_per_record(changed)  # compiles the kernels, or loads them
    seconds_of = interleaved(
        pairs, **{name: lambda changed=changed: cpu_per_record(changed) for name, changed in recipes.items()}
    )
    for name in ("full", "redraw"):
        what = f"{checked.name}, twins: true and undetected: {SETTINGS[name]['undetected']}"
        yield row(f"truth {name}", what, "ms", seconds_of[name], "twins: false", seconds_of["none"])


def cpu_per_record(recipe: Recipe) -> float:
    """CPU time of a record of the first part [ms]."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        row = write_part(make_part(recipe, recipe.records_of_part(0)), Path(folder) / "part.nc", recipe.storage.codec)
        return 1e3 * (time.process_time() - start) / max(row.records, 1)
