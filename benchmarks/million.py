"""What a million one-second records cost, in core hours and on disk, from the cost of a small corpus of the same recipe.

A corpus repeats 1 % of its records at half the step and fills the batches of these, which is more of a small corpus than of a large one: a
million records cost a little less. The alternative simulates one record at a time and writes nothing: ``solve_ivp`` of SciPy on the seed
model, as programs for one bearing do it.
"""

import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from benchmarks.kernel import FULL, SEED, step_seconds
from benchmarks.pairs import Line, cpu_seconds, row
from benchmarks.pipeline import corpus_cost, variant
from benchmarks.rivals import adaptive, spalled
from gen.recipe import find_recipe, read_recipe

RECORDS = 1e6
COMPILED = 64  # records of a first corpus
RECIPES = {"full": (FULL, 512), "domain_randomised": ("domain_randomised", 750)}
IVP = "solve_ivp of SciPy, seed model, one record at a time"


def rows(
    pairs: int = 2, *, recipes: Mapping[str, tuple[Path | str, int]] = RECIPES, sampled_s: float = 0.1
) -> Iterator[Line]:
    """Lines of the table, for recipes with so many records each; ``solve_ivp`` simulates ``sampled_s`` seconds."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for name, (recipe, records) in recipes.items():
            one_second = variant(find_recipe(recipe), folder / f"{name}.yaml", recording={"duration_s": 1})
            yield from _rows_of(name, one_second, records, folder, pairs, sampled_s)


def _rows_of(name: str, recipe: Path, records: int, folder: Path, pairs: int, sampled_s: float) -> Iterator[Line]:
    rival = _of_solve_ivp(sampled_s)
    corpus_cost(recipe, folder, COMPILED)  # compiles the kernels
    costs, others = [], []
    for _ in range(pairs):
        costs.append(corpus_cost(recipe, folder, records))
        others.append(_core_hours(rival()))
    hours = [_core_hours(cost["ms"] / 1e3) for cost in costs]
    what = f"a million one-second records of {name}"
    yield row(f"million {name}", what, "core hours", hours, IVP, others)
    size = [RECORDS * cost["bytes"] / 1e9 for cost in costs]
    plain = [RECORDS * 4 * read_recipe(recipe).recording.sample_rate_hz / 1e9] * pairs
    yield row(f"million {name} disk", f"{what} on disk", "GB", size, "uncompressed float32", plain)
    memory = [cost["MB"] for cost in costs]
    what = f"peak memory of the process, one-second records of {name}"
    yield row(f"million {name} memory", what, "MB", memory, "500 MB", [500.0] * pairs)


def _core_hours(seconds_each: float) -> float:
    """
    >>> _core_hours(0.0036)
    1.0
    """
    return RECORDS * seconds_each / 3600


def _of_solve_ivp(sampled_s: float) -> Callable[[], float]:
    """Function that measures the CPU time of one second of the seed model [s]."""
    dt, factor = step_seconds(SEED)
    seed, state = spalled(SEED, 64)
    return lambda: cpu_seconds(adaptive, seed, state, sampled_s, dt * factor) / sampled_s
