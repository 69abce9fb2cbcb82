"""Speed of this machine from a recipe to records and features, stage by stage, with one worker.

One part is made as :func:`gen.generate` makes it: draw, lay out in lanes, integrate, measure, write; then its features are computed.
The rate of the kernel counts the steps of records, not of empty lanes.
"""

import os
import platform
import statistics
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from features.table import part_features
from gen.corpus import write_part
from gen.labels import part_dataset
from gen.measurement.measure import measure
from gen.physics.kernel.batch import lay_out, record_shape
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.equations import Shape
from gen.physics.kernel.integrate import integrate
from gen.physics.kernel.turning import Lanes
from gen.plan import samples_integrated
from gen.recipe import Recipe, read_recipe
from gen.scenarios import Scenario, draw_scenarios
from gen.simulation.simulate import Response, kernel_record, lead_samples, simulate, steps_per_sample

STAGES = ("draw", "lay_out", "integrate", "measure", "write", "features")
REPEATS = 5
BUDGET_S = 15.0  # no repeat starts after this time


@dataclass(frozen=True)
class Bench:
    """Medians over ``repeats`` runs; ``stage_seconds`` are for all ``records``, and the stage ``integrate`` is the kernel."""

    recipe: str
    records: int
    record_steps: int
    kernel_record_steps_per_second: float
    records_per_second: float
    features_records_per_second: float
    stage_seconds: dict[str, float]
    repeats: int
    machine: dict[str, Any]


def bench(recipe: Path | str, records: int | None = None) -> Bench:
    """Time the stages on the first records of a recipe, by default on the number of records of one part.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    """
    checked = read_recipe(recipe)
    wanted = min(records or checked.corpus.records_per_part, checked.n_records)
    scenarios = draw_scenarios(checked, 0, wanted)
    response = simulate(scenarios, checked)  # compiles the kernels that are not compiled yet
    seconds = _repeated(checked, scenarios, response)
    stages = {stage: statistics.median(times) for stage, times in seconds.items()}
    steps = samples_integrated(checked) * int(response.oversampling.sum())
    making = sum(stages.values()) - stages["features"]
    return Bench(
        recipe=checked.name,
        records=wanted,
        record_steps=steps,
        kernel_record_steps_per_second=steps / stages["integrate"],
        records_per_second=wanted / making,
        features_records_per_second=wanted / stages["features"],
        stage_seconds=stages,
        repeats=len(seconds["features"]),
        machine=machine(),
    )


def _repeated(recipe: Recipe, scenarios: list[Scenario], response: Response) -> dict[str, list[float]]:
    """Seconds of each stage in every run; ``response`` belongs to ``scenarios``, the first records of the recipe."""
    seconds: dict[str, list[float]] = {stage: [] for stage in STAGES}

    def timed(stage: str, work: Callable[..., Any], *given: Any) -> Any:
        start = time.perf_counter()
        result = work(*given)
        seconds[stage].append(time.perf_counter() - start)
        return result

    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part-00000.nc"
        while len(seconds["features"]) < REPEATS and time.perf_counter() - start < BUDGET_S:
            timed("draw", draw_scenarios, recipe, 0, len(scenarios))
            batches = timed("lay_out", _batches, scenarios, recipe)
            timed("integrate", _integrate, batches, recipe)
            measured = timed("measure", measure, response, scenarios, recipe)
            timed("write", _write, measured, scenarios, recipe, response, path)
            timed("features", part_features, path)
    return seconds


Batch = tuple[Shape, Lanes, int]
"""Kernel, records in lanes, steps per sample."""


def _batches(scenarios: list[Scenario], recipe: Recipe) -> list[Batch]:
    """Batches of scenarios, as :func:`gen.simulate` forms them."""
    groups = defaultdict(list)
    for scenario in scenarios:
        record = kernel_record(scenario, recipe)
        factor = steps_per_sample(record, scenario, recipe)
        groups[record_shape(record), factor].append(record)
    knot = 1 / recipe.recording.sample_rate_hz
    return [
        (shape, lay_out(some, shape, knot), factor)
        for (shape, factor), records in groups.items()
        for some in (records[first : first + LANES] for first in range(0, len(records), LANES))
    ]


def _integrate(batches: list[Batch], recipe: Recipe) -> None:
    fs, lead = recipe.recording.sample_rate_hz, lead_samples(recipe)
    n_out = lead + recipe.n_samples
    for shape, lanes, factor in batches:
        taps = decimation(factor)
        integrate(shape, lanes, 1 / (fs * factor), factor, taps, samples_integrated(recipe) - n_out, n_out)


def _write(measured: Any, scenarios: list[Scenario], recipe: Recipe, response: Response, path: Path) -> None:
    write_part(part_dataset(measured, scenarios, recipe, response), path, recipe.corpus.codec)


def machine() -> dict[str, Any]:
    """Processor, cores and versions, which determine the figures."""
    names = ("raceway", "numba", "numpy", "scipy")
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        **{name: version(name) for name in names},
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), platform.machine())
