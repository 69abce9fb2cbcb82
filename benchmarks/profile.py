"""Time that a worker spends on one record, by stage and by part of the kernel.

``python -m benchmarks.profile [RECIPE]``, by default the full model. Each part of the kernel is timed alone on a batch of records of the
recipe, many times from the same knot; the difference to the whole is memory traffic and shared work.
"""

import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit

from benchmarks.kernel import FULL
from benchmarks.pairs import seconds
from gen.physics.kernel.compiling import LANES, zeros
from gen.physics.kernel.decimate import decimation, filter_rows
from gen.physics.kernel.integrate import BLOCK, prepare, set_out, to_next_knot
from gen.physics.kernel.layout import Batch
from gen.physics.kernel.outer_forces import move_forces
from gen.physics.kernel.spalls import move_spalls
from gen.physics.kernel.step import advance
from gen.physics.kernel.turning import STRIDE, move_processes, turn_rings
from gen.physics.kernel.waviness import ball_gaps
from gen.recipe import Recipe, read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import laid_out
from gen.simulation.timeline import timeline
from raceway.studies.timing import bench

KNOTS, TRIES = 400, 25
STEP, ROTATION, SLOW, FORCES, WAVES, SPALLS, PREPARED, FIRST_FILTER, LAST_FILTER = range(9)
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


@njit
def repeat(part: int, shape: Any, batch: Batch, n_steps: int, dt: float, filters: Any, knots: int) -> None:
    """Run one part of the kernel for ``knots`` knots."""
    own = set_out(shape, batch, n_steps)
    work = prepare(shape, own, n_steps)
    width = len(shape.channels) * LANES
    totals = zeros(2 * BLOCK * width, np.float32)
    history, halfway = (
        zeros((len(filters.first.taps) + BLOCK * n_steps) * width, np.float32),
        zeros((len(filters.last.taps) + 64) * width, np.float32),
    )
    for knot in range(STRIDE):
        to_next_knot(shape, own, knot, n_steps, dt, work)
    for knot in range(knots):
        if part == STEP:
            advance(shape, own.state, own.params, dt, n_steps, 0.0, history, 0)
        elif part == ROTATION:
            turn_rings(shape, own, knot, n_steps, dt, work.moves)
        elif part == SLOW:
            if knot % STRIDE == 0:
                move_processes(shape, own, n_steps, work.scratch)
        elif part == FORCES:
            if len(shape.forced):
                move_forces(own, knot, n_steps, dt, work.moves, work.scratch)
                for i in range(own.angles.size):
                    own.angles[i] += work.moves[i]
        elif part == WAVES:
            if len(shape.wavy):
                ball_gaps(shape, own, work.moves, work.scratch, work.gaps)
        elif part == SPALLS:
            if len(shape.spalled):
                move_spalls(shape, own, n_steps, dt, work.moves, work.scratch, work.dropped)
                for i in range(own.angles.size):
                    own.angles[i] += work.moves[i]
        elif part == FIRST_FILTER:
            if knot % BLOCK == 0 and len(filters.first.taps):
                filter_rows(shape.channels, filters.first, 2 * BLOCK, history, 0, halfway, 0, totals)
        elif part == LAST_FILTER and knot % BLOCK == 0:
            filter_rows(shape.channels, filters.last, BLOCK, halfway, 0, history, 0, totals)


def kernel_parts(recipe: Recipe) -> tuple[dict[str, float], int]:
    """Time of each part for each record and knot [s], on the commonest batch of a recipe, and its steps per knot."""
    in_lanes = laid_out(draw_scenarios(recipe, 0, recipe.corpus.records_per_part), recipe)
    commonest = Counter(group for group, _ in in_lanes).most_common(1)[0][0]
    batch = next(batch for group, batch in in_lanes if group == commonest)
    (shape, n_steps), knot = commonest, 1 / timeline(recipe).fs
    given: Any = (shape, batch, n_steps, knot / n_steps, decimation(n_steps))
    repeat(STEP, *given, 1)
    nothing = min(seconds(repeat, PREPARED, *given, KNOTS) for _ in range(TRIES))
    times = {
        name: min(seconds(repeat, part, *given, KNOTS) for _ in range(TRIES)) - nothing for name, part in PARTS.items()
    }
    return {name: max(time, 0.0) / KNOTS / LANES for name, time in times.items()}, n_steps


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else FULL
    recipe = read_recipe(path)
    made = bench(path)
    whole = 1e6 / made.records
    parts, n_steps = kernel_parts(recipe)
    total = sum(made.stage_seconds.values()) - made.stage_seconds["features"]
    print(
        f"{recipe.name}: {recipe.recording.duration_s:g} s at {recipe.recording.sample_rate_hz:g} Hz, {made.records} records\n"
    )
    for stage, time in made.stage_seconds.items():
        share = "" if stage == "features" else f"{time / total:6.0%}"
        print(f"{stage:36}{time * whole:8.0f} us{share}")
        if stage == "integrate":
            knots = timeline(recipe).integrated * 1e6
            for name, part in parts.items():
                print(f"  {name:34}{part * knots:8.0f} us")
            rest = time * whole - sum(parts.values()) * knots
            print(f"  {'idle lanes, copies, the rest':34}{rest:8.0f} us")
    steps = parts["steps"] / n_steps
    print(
        f"\n{n_steps} steps per sample of {steps * 1e9:.1f} ns: {1e-6 / steps:.1f} million record-steps/s in the steps alone"
    )


if __name__ == "__main__":
    main()
