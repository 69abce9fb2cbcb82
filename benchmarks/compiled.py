"""Compile ``plain.c`` and ``intrinsics.c`` into a temporary folder, and call them through ctypes on records in lanes."""

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.seed import N_BALLS, SPACING, FloatArray, Seed, seed_of
from gen.physics.inputs import KernelInput
from gen.physics.kernel.decimate import Decimation, Single, Stage

HERE = Path(__file__).parent
FLAGS = ("-std=gnu99", "-O3", "-march=native", "-ffast-math", "-fPIC")

SOURCES = {
    "plain": ("plain.c", ("-DFUSED=0",)),
    "fused": ("plain.c", ("-DFUSED=1",)),
    "intrinsics": ("intrinsics.c", ()),
}

BLOCK = 64  # samples between two runs of the filters of plain.c
DOUBLES, SINGLES = (np.ctypeslib.ndpointer(kind, flags="C_CONTIGUOUS") for kind in (np.float64, np.float32))

March = Callable[[FloatArray, FloatArray, FloatArray, float, int, int, FloatArray], None]


class Batch(NamedTuple):
    """Records in the rows of the C kernels, one per lane."""

    state: FloatArray
    """Shape (coordinate, lane): x1 y1 x2 y2 and their rates [m, m/s]."""
    turn: FloatArray
    """Directions of cage and shaft, and position of the spall among the balls in units of their distance, shape (row, lane)."""
    params: FloatArray
    """Shape (parameter, lane)."""


Filtered = Callable[[Batch, float, int], Single]


def compiler() -> str | None:
    """Path of the C compiler, if there is one."""
    return shutil.which("cc")


def has_avx512() -> bool:
    """Whether this processor has the instructions of ``intrinsics.c``."""
    try:
        return "avx512dq" in Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return False


def compiled(name: str, lanes: int, spall: int, folder: Path) -> March:
    """A kernel of ``SOURCES`` for a number of lanes and a profile of the spall."""
    march = _library(name, lanes, spall, folder).march
    march.argtypes = [DOUBLES, DOUBLES, DOUBLES, ctypes.c_double, ctypes.c_long, ctypes.c_long, DOUBLES]
    march.restype = None
    return march


def compiled_with_filters(name: str, lanes: int, spall: int, folder: Path, filters: Decimation) -> Filtered:
    """Function that simulates a batch with steps of ``dt`` seconds, and returns so many outputs of the filters of our kernel.

    The outputs are the accelerations x1 y1 x2 y2, shape (sample, coordinate, lane) [m s-2]; the history is zero before the first step.
    """
    first, last = _taps(filters.first), _taps(filters.last)
    factor = filters.first.factor
    steps = factor * filters.last.factor
    sizes = (f"-DSTEPS={steps}", f"-DFIRST={factor}", f"-DFIRST_TAPS={len(first)}", f"-DLAST_TAPS={len(last)}")
    march = _library(name, lanes, spall, folder, *sizes).march_decimated
    march.argtypes = [DOUBLES, DOUBLES, DOUBLES, ctypes.c_double, ctypes.c_long, SINGLES, SINGLES, SINGLES]
    march.restype = None

    def outputs(batch: Batch, dt: float, samples: int) -> Single:
        made = np.empty((-(-samples // BLOCK) * BLOCK, 4, lanes), np.float32)
        march(batch.state.copy(), batch.turn.copy(), batch.params, dt, len(made), first, last, made)
        return made[:samples]

    return outputs


def _taps(stage: Stage) -> Single:
    """Taps of one output of a stage; none if the stage is left out."""
    return np.ascontiguousarray(stage.taps[: stage.kept + 1, 0])


def _library(name: str, lanes: int, spall: int, folder: Path, *sizes: str) -> ctypes.CDLL:
    source, options = SOURCES[name]
    library = folder / f"{'-'.join((name, str(lanes), str(spall), *sizes))}.so"
    given = (f"-DLANES={lanes}", f"-DSPALL={spall}", *options, *sizes)
    subprocess.run(["cc", *FLAGS, *given, "-c", "-o", library.with_suffix(".o"), HERE / source], check=True)
    # linking with -ffast-math would disable subnormal numbers in the whole process
    subprocess.run(["cc", "-shared", "-o", library, library.with_suffix(".o"), "-lm"], check=True)
    return ctypes.CDLL(str(library))


def in_lanes(records: list[KernelInput], lanes: int, dt: float) -> list[Batch]:
    """Records laid out for steps of ``dt`` seconds; some come twice where the last batch would not be full."""
    full = [records[place % len(records)] for place in range(-(-len(records) // lanes) * lanes)]
    return [_batch(*seed_of(full[first : first + lanes]), dt) for first in range(0, len(full), lanes)]


def _batch(seed: Seed, state: FloatArray, dt: float) -> Batch:
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
    return Batch(state, np.stack(turn), np.stack(params))


def accelerations(march: March, batch: Batch, dt: float, samples: int, steps: int) -> FloatArray:
    """Accelerations x1 y1 x2 y2 every ``steps`` steps, shape (sample, coordinate, lane) [m s-2]."""
    made = np.empty((samples, 4, batch.state.shape[1]))
    march(batch.state.copy(), batch.turn.copy(), batch.params, dt, samples, steps, made)
    return made
