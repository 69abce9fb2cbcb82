"""Speed of the step compared with a bound of the processor: the arithmetic and the square roots in the assembly at their measured rates.

The arithmetic bound counts every arithmetic vector instruction of a step but the square roots as one multiplication and addition. Square
roots have a bound of their own, because the divider works beside the other units. The lower bound counts; loads and latency do not.
"""

import ctypes
import re
import statistics
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from benchmarks.compiled import HERE, compiler, has_avx512
from benchmarks.pairs import Line, Skipped, interleaved, row, seconds
from gen.physics.kernel.compiling import LANES, copied, square_root, wide, zeros
from gen.physics.kernel.layout import STATE_ROWS, Shape, make_shape, param_rows
from gen.physics.kernel.step import advance

FLAGS = (
    "-O3",
    "-march=native",
    "-fno-math-errno",
    "-ffp-contract=fast",
    "-mprefer-vector-width=512",
    "-shared",
    "-fPIC",
)
STEPS, STAGES, IN_FLIGHT = 8, 4, 12  # steps per call of advance, stages per step, vectors per pass of the C loops
TIMES = 200_000
ARITHMETIC = re.compile(r"\bv(?:fn?m(?:add|sub)\w+|mul|add|sub|max|min)pd\b|\bvp(?:sra|srl|sub|add)q\b")
ROOTS = re.compile(r"\bvsqrtpd\b")
SHAPES = {
    "seed model": make_shape(9, 1),
    "full model": make_shape(9, 1, resonator=True, damped=True, wavy=True, spalled=True, jittered=True),
    "randomised model": make_shape(
        11, 1, resonator=True, damped=True, wavy=True, spalled=True, jittered=True, struck=True
    ),
}


class Stage(NamedTuple):
    """Vector instructions of one stage of the step for one vector of lanes."""

    operations: int
    roots: int


@njit
def take_steps(shape: Shape, state: Any, params: Any, times: int) -> None:
    """Take ``STEPS * times`` steps and do nothing else."""
    state, params, history = copied(state), copied(params), zeros(STEPS * LANES)
    for _ in range(times):
        advance(shape, state, params, 1e-9, STEPS, 0.0, history, 0)


@njit
def take_roots(values: Any, times: int) -> None:
    """Square roots of all ``values``, in place."""
    wide()
    for _ in range(times):
        for i in range(values.size):
            values[i] = square_root(values[i])


def rows(pairs: int = 15, *, times: int = TIMES, shapes: tuple[str, ...] = tuple(SHAPES)) -> Iterator[Line]:
    """Lines of the table: steps compared with their bound, and our square root compared with that of the processor."""
    if compiler() is None:
        yield Skipped("roofline", "there is no C compiler (cc) on this machine.")
        return
    lanes = 8 if has_avx512() else 4
    with tempfile.TemporaryDirectory() as folder:
        library = _compiled(lanes, Path(folder))
        additions = _rate(library.multiply_and_add, IN_FLIGHT * times, times)
        roots = _rate(library.roots, IN_FLIGHT * lanes * (times // 8), times // 8)
        for name in shapes:
            yield _step_row(name, pairs, times, lanes, additions, roots)
        found = interleaved(pairs, ours=_root_rate(times // 8), processor=roots)
    yield row("roofline roots", "our square root", "1/s", found["ours"], "the processor's", found["processor"])


def _step_row(
    name: str, pairs: int, times: int, lanes: int, additions: Callable[[], float], roots: Callable[[], float]
) -> Line:
    shape = SHAPES[name]
    stage = instructions(shape)
    found = interleaved(pairs, step=_step_rate(shape, times // 1000), vectors=additions, roots=roots)
    bounds = {
        f"its operations, {lanes} lanes at once": [
            rate * lanes / (STAGES * stage.operations) for rate in found["vectors"]
        ],
        f"its roots, {lanes} lanes at once": [rate / (STAGES * max(stage.roots, 1)) for rate in found["roots"]],
    }
    slowest = min(bounds, key=lambda bound: statistics.median(bounds[bound]))
    what = f"step of the {name} alone, {stage.operations} operations and {stage.roots} hardware roots a stage"
    return row(f"roofline {name}", what, "record-steps/s", found["step"], slowest, bounds[slowest])


def instructions(shape: Shape) -> Stage:
    """Vector instructions of a stage of the step: the mean of the long loops over lanes, of which LLVM makes up to four."""
    take_steps(shape, np.zeros(STATE_ROWS * LANES), np.zeros(param_rows(shape, STEPS) * LANES), 0)
    assembly = take_steps.inspect_asm()[take_steps.signatures[-1]]
    counts = [(len(ARITHMETIC.findall(block)), len(ROOTS.findall(block))) for block in re.split(r"\n\S+:", assembly)]
    most = max(operations for operations, _ in counts)
    stages = [count for count in counts if count[0] > most / 2]
    return Stage(*(round(statistics.mean(column)) for column in zip(*stages, strict=True)))


def _compiled(lanes: int, folder: Path) -> ctypes.CDLL:
    library = folder / "roofline.so"
    subprocess.run(["cc", *FLAGS, f"-DLANES={lanes}", "-o", library, HERE / "roofline.c", "-lm"], check=True)
    return ctypes.CDLL(str(library))


def _rate(function: Any, done: int, times: int) -> Callable[[], float]:
    function.argtypes, function.restype = [ctypes.c_long], ctypes.c_double
    return lambda: done / seconds(function, times)


def _step_rate(shape: Shape, times: int) -> Callable[[], float]:
    state, params = np.zeros(STATE_ROWS * LANES), np.zeros(param_rows(shape, STEPS) * LANES)
    take_steps(shape, state, params, 1)
    return lambda: times * STEPS * LANES / seconds(take_steps, shape, state, params, times)


def _root_rate(times: int) -> Callable[[], float]:
    values = np.linspace(1.0, 2.0, 96)
    take_roots(values, 1)
    return lambda: values.size * times / seconds(take_roots, values, times)
