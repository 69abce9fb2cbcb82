"""The kernel compared with C kernels for the seed model alone, and the full model compared with the seed model.

The C kernels return every few accelerations without a filter; our kernel, timed as in :func:`raceway.studies.timing.bench`, filters
them. All run on one core, with the step of the recipe, on the same records.
"""

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.compiled import accelerations, compiled, compiler, has_avx512, in_lanes
from benchmarks.pairs import Line, Skipped, interleaved, row, seconds
from benchmarks.seed import seed_records
from gen.physics.inputs import KernelInput
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.inputs import kernel_input
from gen.simulation.steps import steps_per_sample
from gen.simulation.timeline import timeline
from raceway.studies.timing import bench

SEED, FULL = "ophel2025", Path(__file__).with_name("full.yaml")
UNIT = "record-steps/s"
KINDS = {
    "plain": "C99, short loops over lanes, -O3 -march=native -ffast-math",
    "fused": "the same, all balls in one loop",
    "intrinsics": "C, AVX-512 intrinsics, approximate roots",
}
PLAIN_LANES, INTRINSIC_LANES, TRIES = (8, 16, 32, 64), (8,), 3


def rows(
    pairs: int = 5, *, recipe: Path | str = SEED, full: Path | str = FULL, records: int = 64, samples: int = 12_000
) -> Iterator[Line]:
    """Lines of the table; the C kernels compute ``samples`` samples per call."""
    with tempfile.TemporaryDirectory() as folder:
        rivals = _c_kernels(recipe, records, samples, Path(folder))
        measures = {"ours": lambda: kernel_speed(recipe, records), "full": lambda: kernel_speed(full, min(records, 32))}
        found = interleaved(pairs, **measures, **{name: speed for name, (_, speed) in rivals.items()})
    for source, kind in KINDS.items():
        if source in rivals:
            alternative = f"{kind}, {rivals[source][0]} lanes"
            yield row(f"kernel {source}", "seed model", UNIT, found["ours"], alternative, found[source])
        elif compiler() is None:
            yield Skipped(f"kernel {source}", "there is no C compiler (cc) on this machine.")
        else:
            yield Skipped(f"kernel {source}", "this processor has no AVX-512.")
    yield row("kernel full", "6 DOF and every term", UNIT, found["full"], "our seed model", found["ours"])


def kernel_speed(recipe: Path | str, records: int) -> float:
    """Record-steps per second of our kernel."""
    return bench(recipe, records).kernel_record_steps_per_second


def step_seconds(recipe: Path | str) -> tuple[float, int]:
    """Step of our kernel for the first record of a recipe [s], and steps per sample."""
    checked = read_recipe(recipe)
    (scenario,) = draw_scenarios(checked, 0, 1)
    factor = steps_per_sample(kernel_input(scenario, timeline(checked)), scenario.record.number, checked)
    return 1 / (checked.recording.sample_rate_hz * factor), factor


def _c_kernels(
    recipe: Path | str, records: int, samples: int, folder: Path
) -> dict[str, tuple[int, Callable[[], float]]]:
    """For each C kernel, the number of lanes at which it is fastest here, and a function that measures its record-steps per second."""
    if compiler() is None:
        return {}
    sources = {"plain": PLAIN_LANES, "fused": PLAIN_LANES} | ({"intrinsics": INTRINSIC_LANES} if has_avx512() else {})
    groups = seed_records(read_recipe(recipe), records)
    dt, steps = step_seconds(recipe)
    chosen = {}
    for source, every in sources.items():
        speeds = {lanes: _c_speed(source, lanes, groups, dt, samples, steps, folder) for lanes in every}
        tried = interleaved(TRIES, **{str(lanes): speed for lanes, speed in speeds.items()})
        lanes = max(every, key=lambda lanes: max(tried[str(lanes)]))
        chosen[source] = lanes, speeds[lanes]
    return chosen


def _c_speed(
    source: str, lanes: int, groups: dict[int, list[KernelInput]], dt: float, samples: int, steps: int, folder: Path
) -> Callable[[], float]:
    """Function that measures a C kernel on the records of our kernel."""
    work = [(compiled(source, lanes, spall, folder), in_lanes(records, lanes, dt)) for spall, records in groups.items()]

    def run() -> None:
        for march, batches in work:
            for batch in batches:
                accelerations(march, batch, dt, samples, steps)

    total = samples * steps * lanes * sum(len(batches) for _, batches in work)
    return lambda: total / seconds(run)
