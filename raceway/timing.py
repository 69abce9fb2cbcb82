"""Speed of this machine from a recipe to records and features, stage by stage, with one worker.

One part is made as :func:`gen.generate` makes it: draw, lay out in lanes, integrate, measure, write; then its features are computed.
The rate of the kernel counts the steps of records, not of empty lanes. CPU time of all threads is measured, so that other processes on the
machine count little.
"""

import os
import platform
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from features.table.corpora import block_features
from gen.corpus import RecordBlock, write_part
from gen.generation.labels import part_dataset
from gen.measurement.measure import measure
from gen.physics.kernel.layout import Batch
from gen.recipe import Recipe, read_recipe
from gen.scenarios import Scenario, draw_scenarios, settings_of
from gen.simulation.batches import Group, integrate_batch
from gen.simulation.simulate import Response, integrations, laid_out, simulate
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError

STAGES = ("draw", "lay_out", "integrate", "measure", "write", "features")
REPEATS = 5
BUDGET_S = 15.0  # wall time after which no repeat starts


@dataclass(frozen=True)
class Bench:
    """Medians over ``repeats`` runs, in CPU time; ``stage_seconds`` are for all ``records``, and the stage ``integrate`` is the kernel."""

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
    wanted = min(records or checked.storage.records_per_part, checked.n_records)
    scenarios = draw_scenarios(checked, 0, wanted)
    response = simulate(scenarios)  # compiles the kernels that are not compiled yet
    if len(response.failures) == wanted:
        raise SimulationError(response.failures[0])
    seconds = _repeat(checked, scenarios, response)
    stages = {stage: statistics.median(times) for stage, times in seconds.items()}
    each = zip(scenarios, response.oversampling, strict=True)
    steps = timeline(settings_of(checked)).integrated * sum(
        int(some) * integrations([scenario]) for scenario, some in each
    )
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


def _repeat(recipe: Recipe, scenarios: list[Scenario], response: Response) -> dict[str, list[float]]:
    """Seconds of each stage in every run; ``response`` belongs to ``scenarios``, the first records of the recipe."""
    seconds: dict[str, list[float]] = {stage: [] for stage in STAGES}

    def timed(stage: str, work: Callable[..., Any], *given: Any) -> Any:
        start = time.process_time()
        result = work(*given)
        seconds[stage].append(time.process_time() - start)
        return result

    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part-00000.nc"
        while len(seconds["features"]) < REPEATS and time.perf_counter() - start < BUDGET_S:
            timed("draw", draw_scenarios, recipe, 0, len(scenarios))
            in_lanes = timed("lay_out", laid_out, scenarios)
            timed("integrate", _integrate, in_lanes, recipe)
            measured = timed("measure", measure, response.acceleration, scenarios, response.twins)
            timed("write", _write, measured, recipe, response, path)
            timed("features", block_features, RecordBlock(path, 0, len(scenarios)))
    return seconds


def _integrate(in_lanes: list[tuple[Group, Batch]], recipe: Recipe) -> None:
    for group, batch in in_lanes:
        integrate_batch(group, batch, timeline(settings_of(recipe)))


def _write(measured: Any, recipe: Recipe, response: Response, path: Path) -> None:
    write_part(part_dataset(measured, response), path, recipe.storage.codec)


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
