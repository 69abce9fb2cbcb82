"""How the kernels are compiled: one record per lane, the same bits on every machine.

No floating-point shortcut is left to the compiler: what may be fused says :func:`fma`, and all else is rounded as it is written. So the
bits of a record depend neither on the width of the vectors nor on the company it is in, nor on how far the compiler got with a loop.
What differs between compiled variants is passed as the *length of a tuple*: lengths are part of a type, so numba compiles one kernel
per combination and finds it again in its cache on disk, which it could not for functions built inside functions.
"""

from collections.abc import Callable
from typing import Any, cast

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core.compiler import Compiler
from numba.extending import intrinsic

# Records advanced side by side. The kernel is as fast with 32 and the lanes that fill up a batch are fewer with 16 (domain_randomised: 19 %
# of all instead of 36); with 8 LLVM takes the loop apart and leaves it scalar.
LANES = 16


class _NoAlias(Compiler):
    """Compiles a function for arrays that do not overlap where it writes.

    LLVM would make every loop twice, as vectors and one by one, and ask each time which it may take.
    """

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self.state.flags.noalias = True


CALLED: dict[str, Any] = {"forceinline": True, "error_model": "numpy"}  # from Python too
# Without ways in from Python no machine code is made of what is only ever inlined: half of the time a kernel takes to compile.
# Nor are arrays counted: what is inlined makes none, and counting the views of them took a third of the time between two knots.
# What such a function writes must not be reached through another of its arguments.
INLINE: dict[str, Any] = {
    **CALLED,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,
    "pipeline_class": _NoAlias,
}
ALLOCATING: dict[str, Any] = {**INLINE, "_nrt": True}
# All the rest is inlined into it: a function left on its own is optimised apart in the process that compiles the kernel, and that process
# would give other last bits than those that find the kernel in the cache.
KERNEL: dict[str, Any] = {"error_model": "numpy", "nogil": True, "cache": True}


def _make_wide(context: Any) -> Any:  # noqa: ARG001
    """Let the loops over lanes of the function that calls this use 512-bit vectors, where LLVM would stop at 256 for a processor's sake.

    On such processors (Intel's of 2019 to 2024) half of the arithmetic would lie idle.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')  # llvmlite's own add() knows no such names
        return context.get_dummy_value()

    return types.void(), generate


def _make_lane_count(context: Any) -> Any:  # noqa: ARG001
    """``LANES``, hidden from LLVM, which otherwise unrolls a short loop over lanes before it looks whether it could be vectors."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
        whole, flag, eights = ir.IntType(64), ir.IntType(1), ir.Constant(ir.IntType(64), LANES // 8)
        hidden = builder.asm(ir.FunctionType(whole, [whole]), "", "=r,0", [eights], side_effect=False)
        assume = builder.module.declare_intrinsic("llvm.assume", (), ir.FunctionType(ir.VoidType(), [flag]))
        builder.call(assume, [builder.icmp_unsigned("<=", hidden, eights)])  # so that rows of an array do not overlap
        return builder.shl(hidden, whole(3), flags=("nuw", "nsw"))

    return types.intp(), generate


def _make_fma(context: Any, a: Any, b: Any, c: Any) -> Any:  # noqa: ARG001
    """``a * b + c``, rounded once; in single precision if all three are."""
    kind = types.float32 if a == b == c == types.float32 else types.float64

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
        return builder.fma(*arguments)

    return kind(kind, kind, kind), generate


def _make_bits(context: Any, x: Any) -> Any:  # noqa: ARG001
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), generate


def _make_number(context: Any, bits: Any) -> Any:  # noqa: ARG001
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), generate


wide = cast("Callable[[], None]", intrinsic(_make_wide))
lane_count = cast("Callable[[], int]", intrinsic(_make_lane_count))
fma = cast("Callable[[float, float, float], float]", intrinsic(_make_fma))
_bits = cast("Callable[[float], int]", intrinsic(_make_bits))
_number = cast("Callable[[int], float]", intrinsic(_make_number))


@njit(**ALLOCATING)
def zeros(size: int, kind: Any = np.float64) -> Any:
    """Zeros from an address on where vectors do not straddle the lines of the cache: it halves the time of what streams through it."""
    block = np.zeros(size + 16, kind)
    start = -block.ctypes.data % 64 // block.itemsize
    return block[start : start + size]


@njit(**ALLOCATING)
def copied(values: Any) -> Any:
    """A copy, placed like :func:`zeros`."""
    copy = zeros(values.size)
    for i in range(values.size):
        copy[i] = values[i]
    return copy


@njit(**INLINE)
def square_root(x: float) -> float:
    """Square root of a number that is not negative, to 6e-16.

    Half the exponent gives 0.79 / sqrt(x) to some per cent, a Newton step with constants that suit that [1]_ 1 / sqrt(x) to 9e-4, and the
    series of ``(1 - e)**-0.5``, economised for the ``e`` that is left, the rest: ten multiplications and additions. A processor takes 9
    (Zen 5) to 24 (Golden Cove) cycles for eight square roots, and 5 for these.

    .. [1] L. Moroz et al., "Fast calculation of inverse square root with the use of magic constant: analytical approach", *Appl. Math.
           Comput.* 316 (2018) 245-255.
    """
    y = _number(0x5FE16710B87F3F10 - (_bits(x) >> 1))
    rough = x * y
    stretch = fma(-rough, y, 1.89099012345679)
    root = rough * stretch
    e = fma(-root, y * stretch, 1.0)
    series = fma(e, fma(e, fma(e, 0.2734379724774704, 0.31250095301915864), 0.3749999999999656), 0.4999999999992614)
    return fma(root * e, series, root)


@njit(**INLINE)
def sine(x: float) -> float:
    """Sine of an angle below 0.8 rad, to 1e-11 of its value: a polynomial, since a call would keep the loop over lanes scalar."""
    y = x * x
    tail = fma(y, fma(y, fma(y, fma(y, -1 / 39916800, 1 / 362880), -1 / 5040), 1 / 120), -1 / 6)
    return fma(x * y, tail, x)


@njit(**INLINE)
def cosine(x: float) -> float:
    """Cosine of an angle up to pi/2, to 2e-13."""
    y = x * x
    tail = fma(y, fma(y, fma(y, -1 / 6402373705728000, 1 / 20922789888000), -1 / 87178291200), 1 / 479001600)
    return fma(y, fma(y, fma(y, fma(y, fma(y, fma(y, tail, -1 / 3628800), 1 / 40320), -1 / 720), 1 / 24), -1 / 2), 1.0)
