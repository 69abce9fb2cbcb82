"""The kernel compared with a C program for the seed model alone, and the full model compared with the seed model.

``plain.c`` computes the same outputs from the same records: it takes the same steps and decimates four channels with the same filters. All
run in this thread and are timed by its CPU clock. Steps of records are counted, not those of idle lanes; with the number of records that
``rows`` takes by default no lane is idle in any program.
"""

import ctypes
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.pairs import Line, Skipped, interleaved, row
from benchmarks.seed import N_BALLS, SPACING, FloatArray, Seed, seed_of, seed_records
from gen.physics.kernel.batch import lay_out
from gen.physics.kernel.decimate import Decimation, Single, Stage, decimation
from gen.physics.kernel.layout import Batch, Shape
from gen.physics.kernel_input import KernelInput
from gen.recipe import read_recipe
from gen.scenarios import Scenario, draw_scenarios
from gen.simulation.batches import batches, integrate_batch
from gen.simulation.simulate import open_integrations, runs_of
from gen.simulation.timeline import Timeline, timeline

SEED, FULL = "ophel2025", Path(__file__).with_name("full.yaml")
UNIT = "record-steps/s"
PLAIN = "C99 with the same filters, short loops over lanes, -O3 -march=native -ffast-math"
LANES, TRIES = (8, 16, 32, 64), 3
HERE = Path(__file__).parent
FLAGS = ("-std=gnu99", "-O3", "-march=native", "-ffast-math", "-fPIC")
BLOCK = 64  # samples between two runs of the filters of plain.c
DOUBLES, SINGLES = (np.ctypeslib.ndpointer(kind, flags="C_CONTIGUOUS") for kind in (np.float64, np.float32))
Rate = Callable[[], float]


class CBatch(NamedTuple):
    """Records in the rows of ``plain.c``, one per lane."""

    state: FloatArray
    """Shape (coordinate, lane): x1 y1 x2 y2 and their rates [m, m/s]."""
    turn: FloatArray
    """Directions of cage and shaft, and position of the spall among the balls in units of their distance, shape (row, lane)."""
    params: FloatArray
    """Shape (parameter, lane)."""


Outputs = Callable[[CBatch, float, int], Single]


def rows(
    pairs: int = 5, *, recipe: Path | str = SEED, full: Path | str = FULL, records: int = 128, full_records: int = 32
) -> Iterator[Line]:
    """Lines of the table: ``records`` records of the seed model, 64 healthy and 64 with a fault in every program."""
    with tempfile.TemporaryDirectory() as folder:
        theirs = {"plain": _c_rate(recipe, records, Path(folder))} if compiler() else {}
        ours = {"ours": kernel_rate(recipe, records), "full": kernel_rate(full, full_records)}
        speeds = interleaved(pairs, **ours, **theirs)
    if theirs:
        yield row("kernel plain", "seed model, one core", UNIT, speeds["ours"], PLAIN, speeds["plain"])
    else:
        yield Skipped("kernel plain", "there is no C compiler (cc) on this machine.")
    yield row("kernel full", "full model: 6 DOF and every term", UNIT, speeds["full"], "our seed model", speeds["ours"])


def kernel_rate(recipe: Path | str, records: int) -> Rate:
    """Function that measures the record-steps per second of our kernel on the first records of a recipe."""
    checked = read_recipe(recipe)
    once = checked.truth.model_copy(update={"twins": False})  # no second run of a record without its fault
    checked = checked.model_copy(update={"truth": once})
    axis, scenarios = timeline(checked), draw_scenarios(checked, 0, records)
    work = laid_out(scenarios)
    total = (axis.dropped + axis.returned) * sum(run.oversampling for run in runs_of(scenarios))
    integrate_every(work, axis)  # compiles the kernels, or loads them
    return _rate(total, lambda: integrate_every(work, axis))


def laid_out(scenarios: list[Scenario]) -> list[tuple[Shape, int, Batch]]:
    """Shape, steps per sample and lanes of each batch of possible scenarios, as they are simulated."""
    work, fs = [], scenarios[0].recipe.recording.sample_rate_hz
    for records in batches(open_integrations(runs_of(scenarios))):
        shape, steps = records[0].group
        work.append((shape, steps, lay_out([record.kernel_input for record in records], shape, 1 / fs)))
    return work


def integrate_every(work: list[tuple[Shape, int, Batch]], axis: Timeline) -> None:
    """Integrate batches, and drop the result."""
    for shape, steps, batch in work:
        integrate_batch(shape, steps, batch, axis)


def step_seconds(recipe: Path | str) -> tuple[float, int]:
    """Step of our kernel for the first record of a recipe [s], and steps per sample."""
    checked = read_recipe(recipe)
    (scenario,) = draw_scenarios(checked, 0, 1)
    (run,) = runs_of([scenario])
    factor = run.oversampling
    return 1 / (checked.recording.sample_rate_hz * factor), factor


def _rate(total: int, run: Callable[[], None]) -> Rate:
    """Function that measures ``total`` over the CPU time of this thread in ``run``."""

    def rate() -> float:
        start = time.thread_time()
        run()
        return total / (time.thread_time() - start)

    return rate


def _c_rate(recipe: Path | str, records: int, folder: Path) -> Rate:
    """Function that measures the record-steps per second of the C program at the number of lanes at which it is fastest here."""
    checked = read_recipe(recipe)
    axis, groups = timeline(checked), seed_records(checked, records)
    samples = axis.dropped + axis.returned
    dt, steps = step_seconds(recipe)
    total = samples * steps * sum(map(len, groups.values()))
    rates = {}
    for lanes in LANES:
        work = [
            (compiled(lanes, spall, folder, decimation(steps)), in_lanes(some, lanes, dt))
            for spall, some in groups.items()
        ]
        rates[str(lanes)] = _rate(total, lambda work=work: _simulate(work, dt, samples))
    tried = interleaved(TRIES, **rates)
    return rates[max(rates, key=lambda lanes: max(tried[lanes]))]


def _simulate(work: list[tuple[Outputs, list[CBatch]]], dt: float, samples: int) -> None:
    for outputs, rows_of in work:
        for batch in rows_of:
            outputs(batch, dt, samples)


def compiler() -> str | None:
    """Path of the C compiler, if there is one."""
    return shutil.which("cc")


def compiled(lanes: int, spall: int, folder: Path, filters: Decimation) -> Outputs:
    """Function that simulates a batch with steps of ``dt`` seconds, and returns so many outputs of the filters of our kernel.

    The outputs are the accelerations x1 y1 x2 y2, shape (sample, coordinate, lane) [m s-2]; the history is zero before the first step.
    """
    first, last = _taps(filters.first), _taps(filters.last)
    factor = filters.first.factor
    steps = factor * filters.last.factor
    sizes = (f"-DSTEPS={steps}", f"-DFIRST={factor}", f"-DFIRST_TAPS={len(first)}", f"-DLAST_TAPS={len(last)}")
    flags = (f"-DLANES={lanes}", f"-DSPALL={spall}", *sizes)
    library = folder / f"{''.join(flags)}.so"
    subprocess.run(["cc", *FLAGS, *flags, "-c", "-o", library.with_suffix(".o"), HERE / "plain.c"], check=True)
    # linking with -ffast-math would disable subnormal numbers in the whole process
    subprocess.run(["cc", "-shared", "-o", library, library.with_suffix(".o"), "-lm"], check=True)
    march = ctypes.CDLL(str(library)).march
    march.argtypes = [DOUBLES, DOUBLES, DOUBLES, ctypes.c_double, ctypes.c_long, SINGLES, SINGLES, SINGLES]
    march.restype = None

    def outputs(batch: CBatch, dt: float, samples: int) -> Single:
        states = np.empty((-(-samples // BLOCK) * BLOCK, 4, lanes), np.float32)
        march(batch.state.copy(), batch.turn.copy(), batch.params, dt, len(states), first, last, states)
        return states[:samples]

    return outputs


def _taps(stage: Stage) -> Single:
    """Taps of one output of a stage; none if the stage is left out."""
    return np.ascontiguousarray(stage.taps[: stage.kept + 1, 0])


def in_lanes(records: list[KernelInput], lanes: int, dt: float) -> list[CBatch]:
    """Records laid out for steps of ``dt`` seconds; some come twice where the last batch would not be full."""
    full = [records[place % len(records)] for place in range(-(-len(records) // lanes) * lanes)]
    return [_batch(*seed_of(full[first : first + lanes]), dt) for first in range(0, len(full), lanes)]


def _batch(seed: Seed, state: FloatArray, dt: float) -> CBatch:
    passed = (seed.shaft_angle + seed.spall_angle - seed.cage_angle) / SPACING % N_BALLS
    cage, shaft = seed.cage_rate * dt / 2, seed.omega * dt / 2
    turn = [
        np.cos(seed.cage_angle),
        np.sin(seed.cage_angle),
        np.cos(seed.shaft_angle),
        np.sin(seed.shaft_angle),
        passed,
    ]
    params = [
        seed.load_deflection_factor, seed.half_clearance, 1 / seed.shaft_mass, 1 / seed.housing_mass, seed.ring_damping,
        seed.support_stiffness_x, seed.support_stiffness_y, seed.support_damping_x, seed.support_damping_y, seed.load_x,
        seed.load_y, seed.unbalance, np.cos(cage), np.sin(cage), np.cos(shaft), np.sin(shaft), (shaft - cage) / SPACING,
        seed.half_span, seed.inner_radius, seed.depth, seed.ball_radius,
    ]  # fmt: skip
    return CBatch(state, np.stack(turn), np.stack(params))
