"""The kernel against kernels in C written for the seed model alone, and the full model against the seed.

The C kernels hand on the accelerations of every few steps as they are; ours, timed as :func:`raceway.bench.bench` does, filters them first.
All run on one core, at the recipe's own step, on the same records.
"""

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.compiled import March, accelerations, compiled, compiler, has_avx512, in_lanes
from benchmarks.pairs import Line, Series, Skipped, interleaved, row, seconds
from benchmarks.seed import Record, seed_records
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from gen.simulate import kernel_record, steps_per_sample
from raceway.bench import bench

SEED, FULL = "ophel2025", Path(__file__).with_name("full.yaml")
UNIT = "record-steps/s"
PLAIN_LANES, INTRINSIC_LANES = (8, 16, 32, 64), (8,)


def rows(pairs: int = 5, *, recipe: Path | str = SEED, full: Path | str = FULL, records: int = 64, samples: int = 12_000) -> Iterator[Line]:
    """Lines of the table."""
    with tempfile.TemporaryDirectory() as folder:
        measures = {
            "ours": lambda: kernel_speed(recipe, records),
            "full": lambda: kernel_speed(full, min(records, 32)),
        } | _c_kernels(recipe, records, samples, Path(folder))
        found = interleaved(pairs, **measures)
    yield from _against(found, "plain", "C99, -O3 -march=native -ffast-math, the seed model only")
    yield from _against(found, "intrinsics", "C, AVX-512 intrinsics, the seed model only")
    yield row("kernel full", "6 DOF and every term", UNIT, found["full"], "our seed model", found["ours"])


def kernel_speed(recipe: Path | str, records: int) -> float:
    """Record-steps per second of our kernel."""
    return bench(recipe, records).kernel_record_steps_per_second


def step_seconds(recipe: Path | str) -> tuple[float, int]:
    """Step that our kernel takes for the first record of a recipe [s], and steps per sample."""
    checked = read_recipe(recipe)
    (scenario,) = draw_scenarios(checked, 0, 1)
    factor = steps_per_sample(kernel_record(scenario, checked), scenario, checked)
    return 1 / (checked.recording.sample_rate_hz * factor), factor


def _against(found: dict[str, Series], name: str, alternative: str) -> Iterator[Line]:
    if name in found:
        yield row(f"kernel {name}", "seed model", UNIT, found["ours"], alternative, found[name])
    elif compiler() is None:
        yield Skipped(f"kernel {name}", "there is no C compiler (cc) on this machine.")
    else:
        yield Skipped(f"kernel {name}", "this processor has no AVX-512.")


def _c_kernels(recipe: Path | str, records: int, samples: int, folder: Path) -> dict[str, Callable[[], float]]:
    if compiler() is None:
        return {}
    sources = {"plain": PLAIN_LANES} | ({"intrinsics": INTRINSIC_LANES} if has_avx512() else {})
    groups = seed_records(read_recipe(recipe), records)
    dt, steps = step_seconds(recipe)
    return {
        source: max(
            (_timed(source, lanes, groups, dt, samples, steps, folder) for lanes in every), key=lambda speed: max(speed(), speed())
        )
        for source, every in sources.items()
    }


def _timed(
    source: str, lanes: int, groups: dict[int, list[Record]], dt: float, samples: int, steps: int, folder: Path
) -> Callable[[], float]:
    """What measures the record-steps per second of a C kernel on the records our kernel is given."""
    work: list[tuple[March, list]] = [
        (compiled(source, lanes, spall, folder), in_lanes(records, lanes, dt)) for spall, records in groups.items()
    ]

    def run() -> None:
        for march, batches in work:
            for batch in batches:
                accelerations(march, batch, dt, samples, steps)

    total = samples * steps * lanes * sum(len(batches) for _, batches in work)
    return lambda: total / seconds(run)
