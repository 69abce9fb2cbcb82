"""The kernel compared with C programs for the seed model alone, and the full model compared with the seed model.

The C program ``plain.c`` computes the same outputs from the same records: it takes the same steps and decimates four channels with the
same filters. ``intrinsics.c`` takes the steps only, as an upper bound. All run in this thread and are timed by its CPU clock. Steps of
records are counted, not those of idle lanes; with the number of records that ``rows`` takes by default no lane is idle in any program.
"""

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.compiled import accelerations, compiled, compiled_with_filters, compiler, has_avx512, in_lanes
from benchmarks.pairs import Line, Skipped, interleaved, row
from benchmarks.seed import seed_records
from gen.physics.inputs import KernelInput
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.layout import Batch
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.batches import Group, integrate_batch
from gen.simulation.inputs import kernel_input
from gen.simulation.simulate import laid_out
from gen.simulation.steps import steps_per_sample
from gen.simulation.timeline import Timeline, timeline

SEED, FULL = "ophel2025", Path(__file__).with_name("full.yaml")
UNIT = "record-steps/s"
KINDS = {
    "plain": "C99 with the same filters, short loops over lanes, -O3 -march=native -ffast-math",
    "fused": "the same, all balls in one loop",
    "intrinsics": "C, AVX-512 intrinsics, approximate roots, steps only",
}
PLAIN_LANES, INTRINSIC_LANES, TRIES = (8, 16, 32, 64), (8,), 3
Rate = Callable[[], float]
Groups = dict[int, list[KernelInput]]


def rows(
    pairs: int = 9, *, recipe: Path | str = SEED, full: Path | str = FULL, records: int = 128, full_records: int = 32
) -> Iterator[Line]:
    """Lines of the table: ``records`` records of the seed model, 64 healthy and 64 with a fault in every program."""
    with tempfile.TemporaryDirectory() as folder:
        rivals = _c_rates(recipe, records, Path(folder))
        ours = {"ours": kernel_rate(recipe, records), "full": kernel_rate(full, full_records)}
        found = interleaved(pairs, **ours, **rivals)
    for source, kind in KINDS.items():
        if source in rivals:
            yield row(f"kernel {source}", "seed model, one core", UNIT, found["ours"], kind, found[source])
        elif compiler() is None:
            yield Skipped(f"kernel {source}", "there is no C compiler (cc) on this machine.")
        else:
            yield Skipped(f"kernel {source}", "this processor has no AVX-512.")
    yield row("kernel full", "full model: 6 DOF and every term", UNIT, found["full"], "our seed model", found["ours"])


def kernel_rate(recipe: Path | str, records: int) -> Rate:
    """Function that measures the record-steps per second of our kernel on the first records of a recipe."""
    checked = read_recipe(recipe)
    once = checked.truth.model_copy(update={"twins": False})  # no second run of a record without its fault
    checked = checked.model_copy(update={"truth": once})
    axis, scenarios = timeline(settings_of(checked)), draw_scenarios(checked, 0, records)
    batches = laid_out(scenarios)
    total = axis.integrated * sum(
        steps_per_sample(kernel_input(scenario, axis), scenario.record.number, settings_of(checked))
        for scenario in scenarios
    )
    integrate_every(batches, axis)  # compiles the kernels, or loads them
    return _rate(total, lambda: integrate_every(batches, axis))


def integrate_every(batches: list[tuple[Group, Batch]], axis: Timeline) -> None:
    """Integrate batches, and drop the result."""
    for group, batch in batches:
        integrate_batch(group, batch, axis)


def step_seconds(recipe: Path | str) -> tuple[float, int]:
    """Step of our kernel for the first record of a recipe [s], and steps per sample."""
    checked = read_recipe(recipe)
    (scenario,) = draw_scenarios(checked, 0, 1)
    factor = steps_per_sample(
        kernel_input(scenario, timeline(settings_of(checked))), scenario.record.number, settings_of(checked)
    )
    return 1 / (checked.recording.sample_rate_hz * factor), factor


def _rate(total: int, run: Callable[[], None]) -> Rate:
    """Function that measures ``total`` over the CPU time of this thread in ``run``."""

    def rate() -> float:
        start = time.thread_time()
        run()
        return total / (time.thread_time() - start)

    return rate


def _c_rates(recipe: Path | str, records: int, folder: Path) -> dict[str, Rate]:
    """For each C program, a function that measures its record-steps per second at the number of lanes at which it is fastest here."""
    if compiler() is None:
        return {}
    sources = {"plain": PLAIN_LANES, "fused": PLAIN_LANES} | ({"intrinsics": INTRINSIC_LANES} if has_avx512() else {})
    checked = read_recipe(recipe)
    groups, samples, (dt, steps) = (
        seed_records(checked, records),
        timeline(settings_of(checked)).integrated,
        step_seconds(recipe),
    )
    chosen = {}
    for source, every in sources.items():
        of_source = _steps_only if source == "intrinsics" else _filtered
        rates = {lanes: of_source(source, lanes, groups, dt, samples, steps, folder) for lanes in every}
        tried = interleaved(TRIES, **{str(lanes): rate for lanes, rate in rates.items()})
        chosen[source] = rates[max(every, key=lambda lanes: max(tried[str(lanes)]))]
    return chosen


def _filtered(source: str, lanes: int, groups: Groups, dt: float, samples: int, steps: int, folder: Path) -> Rate:
    filters = decimation(steps)
    work = [
        (compiled_with_filters(source, lanes, spall, folder, filters), in_lanes(records, lanes, dt))
        for spall, records in groups.items()
    ]

    def run() -> None:
        for outputs, batches in work:
            for batch in batches:
                outputs(batch, dt, samples)

    return _rate(samples * steps * sum(map(len, groups.values())), run)


def _steps_only(source: str, lanes: int, groups: Groups, dt: float, samples: int, steps: int, folder: Path) -> Rate:
    work = [(compiled(source, lanes, spall, folder), in_lanes(records, lanes, dt)) for spall, records in groups.items()]

    def run() -> None:
        for march, batches in work:
            for batch in batches:
                accelerations(march, batch, dt, samples, steps)

    return _rate(samples * steps * sum(map(len, groups.values())), run)
