"""Time that a worker spends on one record, by stage and by part of the kernel.

``python -m benchmarks.profile [RECIPE]``, by default the full model. Batches of the commonest kernel and step are integrated whole and
with one part left out, in thread CPU time; the difference is the time of that part, with the state of the caches that it has in a record.
A record with a fault counts both of its integrations if the recipe also asks for it without the fault.
"""

import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from benchmarks.kernel import FULL
from gen.physics.kernel.compiling import LANES, zeros
from gen.physics.kernel.decimate import decimation, filter_rows
from gen.physics.kernel.integrate import BLOCK, keep, prepare, set_out, watch
from gen.physics.kernel.layout import Batch
from gen.physics.kernel.outer_forces import move_forces
from gen.physics.kernel.spalls import move_spalls
from gen.physics.kernel.step import advance
from gen.physics.kernel.turning import STRIDE, keep_turning, move_processes, new_walk, turn_rings
from gen.physics.kernel.waviness import move_gaps
from gen.recipe import Recipe, read_recipe
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.batches import integrate_batch
from gen.simulation.simulate import integrations, laid_out
from gen.simulation.timeline import timeline
from raceway.studies.timing import bench

KNOTS, TRIES, BATCHES = 1200, 10, 6
NOTHING, STEP, ROTATION, SLOW, FORCES, WAVES, SPALLS, FIRST_FILTER, LAST_FILTER = range(9)
PARTS = {
    "steps": STEP,
    "rotation of shaft, cage and balls": ROTATION,
    "speed, slip, spin and jitter": SLOW,
    "forces from outside": FORCES,
    "waviness": WAVES,
    "spalls": SPALLS,
    "first filter": FIRST_FILTER,
    "last filter": LAST_FILTER,
}
REST = "watch, copies, the rest"


class Load(NamedTuple):
    """What a recipe asks of the kernel, for each record of a part."""

    lanes: float
    """Integrations, idle lanes included."""
    busy: float
    """Share of the lanes that hold a record of their own."""
    steps: float
    """Mean number of steps per sample, over lanes."""
    seconds: float
    """Thread CPU time of the whole kernel for each record [s]."""


@njit
def march(without: int, shape: Any, batch: Batch, n_steps: int, dt: float, filters: Any, knots: int) -> None:
    """Integrate a batch for ``knots`` knots as the kernel does, but for the part ``without``."""
    own = set_out(shape, batch, n_steps)
    work = prepare(shape, own, n_steps)
    width = len(shape.channels) * LANES
    two_stages = len(filters.first.taps) > 0
    first_stage = filters.first if two_stages else filters.last
    kept, half_kept = first_stage.kept, filters.last.kept
    totals, out = zeros(2 * BLOCK * width, np.float32), zeros((knots + BLOCK) * width, np.float32)
    history = zeros((kept + BLOCK * n_steps + 4) * width, np.float32)
    halfway = zeros((half_kept + 2 * BLOCK + 4) * width, np.float32)
    diverged = np.full(LANES, -1)
    for knot in range(knots):
        if knot % STRIDE == 0 and (knot == 0 or without != SLOW):
            move_processes(shape, own, n_steps, work.scratch)
            new_walk(own, knot)
        if knot == 0 or without != ROTATION:
            turn_rings(shape, own, knot, n_steps, dt, work.moves)
        if len(shape.forced) and without != FORCES:
            move_forces(own, knot, n_steps, dt, work.moves, work.scratch)
        if len(shape.wavy) and (knot == 0 or without != WAVES):
            move_gaps(shape, own, knot, n_steps, work.moves, work.scratch, work.gaps)
        if len(shape.spalled) and without != SPALLS:
            move_spalls(shape, own, n_steps, dt, work.moves, work.scratch, work.met)
        keep_turning(shape, own, work.moves)
        if without != STEP:
            at = (kept + knot % BLOCK * n_steps) * len(shape.channels)
            advance(shape, own.state, own.params, dt, n_steps, 2.0 * n_steps * (knot % STRIDE), history, at)
        watch(own.state, knot, diverged)
        if (knot + 1) % BLOCK == 0:
            if two_stages and without != FIRST_FILTER:
                filter_rows(shape.channels, first_stage, 2 * BLOCK, history, 0, halfway, half_kept, totals)
            if without != LAST_FILTER:
                source = halfway if two_stages else history
                filter_rows(shape.channels, filters.last, BLOCK, source, 0, out, knot + 1 - BLOCK, totals)
            keep(history, kept * width, BLOCK * n_steps * width)
            keep(halfway, half_kept * width, 2 * BLOCK * width)


def kernel_parts(recipe: Recipe) -> tuple[dict[str, float], int, Load]:
    """Time of each part for each lane and knot [s], mean over batches of the commonest kernel and step; its steps per knot; the load."""
    scenarios = draw_scenarios(recipe, 0, min(recipe.storage.records_per_part, recipe.n_records))
    in_lanes = laid_out(scenarios)
    (shape, n_steps), _ = Counter(group for group, _ in in_lanes).most_common(1)[0]
    every = [batch for group, batch in in_lanes if group == (shape, n_steps)]
    chosen = every[:: -(-len(every) // BATCHES)]
    lanes = LANES * len(in_lanes)
    steps = sum(group.steps for group, _ in in_lanes) / len(in_lanes)
    start = time.thread_time()
    for group, batch in in_lanes:
        integrate_batch(group, batch, timeline(settings_of(recipe)))
    kernel = (time.thread_time() - start) / len(scenarios)
    load = Load(lanes / len(scenarios), integrations(scenarios) / lanes, steps, kernel)
    knot = 1 / timeline(settings_of(recipe)).fs
    given: Any = (n_steps, knot / n_steps, decimation(n_steps), KNOTS)
    march(NOTHING, shape, chosen[0], *given)
    best = np.full((len(PARTS) + 1, len(chosen)), np.inf)
    for _ in range(TRIES):
        for column, batch in enumerate(chosen):
            for row, without in enumerate((NOTHING, *PARTS.values())):
                best[row, column] = min(best[row, column], _cpu_seconds(without, shape, batch, *given))
    whole, *others = best.mean(axis=1) / KNOTS / LANES
    times = {name: max(whole - other, 0.0) for name, other in zip(PARTS, others, strict=True)}
    return times | {REST: whole - sum(times.values())}, n_steps, load


def _cpu_seconds(*given: Any) -> float:
    start = time.thread_time()
    march(*given)
    return time.thread_time() - start


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else FULL
    recipe = read_recipe(path)
    made = bench(path)
    whole = 1e6 / made.records
    parts, n_steps, load = kernel_parts(recipe)
    total = sum(made.stage_seconds.values()) - made.stage_seconds["features"]
    print(
        f"{recipe.name}: {recipe.recording.duration_s:g} s at {recipe.recording.sample_rate_hz:g} Hz, {made.records} records\n"
    )
    for stage, seconds in made.stage_seconds.items():
        share = "" if stage == "features" else f"{seconds / total:6.0%}"
        print(f"{stage:36}{seconds * whole:8.0f} us{share}")
        if stage == "integrate":
            _print_parts(parts, n_steps, load, timeline(settings_of(recipe)).integrated * 1e6)
    steps = parts["steps"] / n_steps
    print(
        f"\n{load.lanes * load.busy:.2f} integrations of a record; {load.busy:.0%} of the lanes at work\n"
        f"{load.steps:.1f} steps per sample of {steps * 1e9:.1f} ns: {1e-6 / steps:.1f} million record-steps/s in the steps alone"
    )


def _print_parts(parts: dict[str, float], n_steps: int, load: Load, knots: float) -> None:
    """Print the CPU time of the parts for each record [us]; steps and first filter grow with the steps per sample, the others do not."""
    longer = {"steps": load.steps / n_steps, "first filter": load.steps / n_steps}
    each = {name: knots * load.lanes * time * longer.get(name, 1.0) for name, time in parts.items()}
    print(f"  {'in CPU time':34}{1e6 * load.seconds:8.0f} us")
    for name, taken in each.items():
        print(f"  {name:34}{load.busy * taken:8.0f} us")
    print(f"  {'idle lanes':34}{(1 - load.busy) * sum(each.values()):8.0f} us")
    print(f"  {'other batches, not explained':34}{1e6 * load.seconds - sum(each.values()):8.0f} us")


if __name__ == "__main__":
    main()
