"""Speed of this machine from a recipe to records and features, stage by stage, with one worker.

Records are made by the steps of :func:`gen.generate`, faults that are drawn again included, and discarded; then their features are
computed. CPU time of all threads is measured, so that other processes on the machine count little.
"""

import math
import os
import platform
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from features.table.corpora import block_features
from gen.corpus import RecordBlock, part_name
from gen.generation.compilation import compile_kernels, missing_kernels
from gen.generation.forecast import expected_work, seconds_of
from gen.generation.parts import Outcome, write_made
from gen.generation.scheduling import STAGES, Making
from gen.recipe import read_recipe
from gen.scenarios import settings_of
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError

USUAL_S = 10.0  # of records to time


@dataclass(frozen=True)
class Bench:
    """CPU times; ``stage_seconds`` are for all ``records``, and the stage ``integrate`` is the kernel."""

    recipe: str
    records: int
    record_steps: int
    kernel_record_steps_per_second: float
    records_per_second: float
    features_records_per_second: float
    stage_seconds: dict[str, float]
    machine: dict[str, Any]


def bench(recipe: Path | str, records: int | None = None) -> Bench:
    """Time the stages on the first records of a recipe, by default on as many as take some seconds.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    """
    checked = read_recipe(recipe)
    usual = math.ceil(checked.n_records * USUAL_S / seconds_of(expected_work(checked)))
    wanted, size = min(records or usual, checked.n_records), checked.storage.records_per_part
    compile_kernels(checked, missing_kernels(checked))
    seconds, steps = dict.fromkeys([*STAGES, "features"], 0.0), 0

    @contextmanager
    def timed(stage: str) -> Iterator[None]:
        start = time.process_time()
        yield
        seconds[stage] += time.process_time() - start

    with tempfile.TemporaryDirectory() as folder:
        parts = [range(first, min(first + size, wanted)) for first in range(0, wanted, size)]
        making = Making(checked, parts, lambda made: write_made(made, checked, Path(folder) / part_name(made.place)))
        outcomes = list[Outcome]()
        while (step := making.next_step()) is not None:
            with timed(step.stage):
                outcomes += step.do()
            steps += step.per_sample * timeline(settings_of(checked)).integrated
        blocks = [RecordBlock(Path(folder) / one.row.name, 0, one.row.records) for one in outcomes if one.row.records]
        if not blocks:
            raise SimulationError(outcomes[0].failures[0])
        block_features(blocks[0]._replace(stop=1))  # loads libraries
        for block in blocks:
            with timed("features"):
                block_features(block)
    made = sum(block.stop for block in blocks)
    return Bench(
        recipe=checked.name,
        records=made,
        record_steps=steps,
        kernel_record_steps_per_second=steps / seconds["integrate"],
        records_per_second=made / sum(seconds[stage] for stage in STAGES),
        features_records_per_second=made / seconds["features"],
        stage_seconds=seconds,
        machine=machine(),
    )


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
