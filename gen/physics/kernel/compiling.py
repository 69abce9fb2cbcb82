"""How the kernels are compiled: one record per lane, the same bits on every machine.

Only explicit :func:`fma` calls are fused, and every other operation is rounded as it is written. So a record does not depend on vector
width, batch or optimiser. One kernel serves all records: numbers of balls and channels, and the parts of the model that a record needs,
are values that it is given. Loops over lanes are the innermost, since LLVM vectorises no others.
"""

import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core.compiler import Compiler
from numba.extending import intrinsic, register_jitable

from gen.support.kernel_cache import keep_on_disk
from gen.support.sources import hash_sources

# Records advanced side by side. With 32 the kernel is 4 to 8 % slower on Zen 4: the rows of a batch leave the first cache.
LANES = 16


class _NoAlias(Compiler):
    """Compile a function for arrays that do not overlap where it writes.

    Otherwise LLVM compiles every loop twice, in vectors and in scalars, and tests each time which of them is allowed.
    """

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.state.flags.noalias = True


Function = TypeVar("Function", bound=Callable[..., Any])

CALLED: dict[str, Any] = {"forceinline": True, "error_model": "numpy"}  # also callable from Python, which compiles it
# Without wrappers for Python no machine code is made of functions that are only inlined: a kernel compiles in half the time.
# Without _nrt references to arrays are not counted: inlined functions make no arrays, and counting views took a third of the time
# between two knots. Such a function must not write to an array that another of its arguments shares.
INLINE: dict[str, Any] = {
    **CALLED,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,
    "pipeline_class": _NoAlias,
}
ALLOCATING: dict[str, Any] = {**INLINE, "_nrt": True}
# Every other function is inlined into the kernel: a helper compiled on its own is optimised separately in the process that compiles the
# kernel, and rounds differently there from the cached kernel in other processes.
KERNEL: dict[str, Any] = {"error_model": "numpy", "nogil": True}


def in_both(function: Function) -> Function:
    """Inline a function into the kernel, and leave it plain Python elsewhere: each process would compile it for calls from Python."""
    return register_jitable(**INLINE)(function)


def compiled_to_disk(function: Callable[..., Any]) -> Any:
    """Compile a kernel and keep it on disk, as long as its file and this physics are the same."""
    return keep_on_disk(njit(**KERNEL)(function), hash_sources("gen/physics"))


def _make_wide(_typing: Any) -> Any:
    """Allow 512-bit vectors in the loops over lanes of the calling function.

    LLVM limits vectors to 256 bits on Intel processors of 2019 to 2024, and half of their arithmetic units would be unused.
    """

    def generate(context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')  # llvmlite's own add() knows no such names
        return context.get_dummy_value()

    return types.void(), generate


def _make_lane_count(_typing: Any, _n_records: Any) -> Any:
    """Lanes of whole vectors that hold so many records, at most ``LANES``.

    Their number is hidden from LLVM, which otherwise unrolls a short loop over lanes before it tries to vectorise it.
    """

    def generate(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        _, _, features = context.codegen().magic_tuple()
        whole, bits = ir.IntType(64), 3 if "+avx512f" in features else 2  # numbers of 64 bits in a vector: 8 or 4
        vectors = builder.lshr(builder.add(arguments[0], whole((1 << bits) - 1)), whole(bits))
        hidden = builder.asm(ir.FunctionType(whole, [whole]), "", "=r,0", [vectors], side_effect=False)
        _assume_below(builder, hidden, (LANES >> bits) + 1)  # so that rows of an array do not overlap
        return builder.shl(hidden, whole(bits), flags=("nuw", "nsw"))

    return types.intp(types.intp), generate


def _make_as_lane(_typing: Any, _lane: Any) -> Any:
    """A number that is a lane; LLVM does not see that in long loops, and would load vectors value by value."""

    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        _assume_below(builder, arguments[0], LANES)
        return arguments[0]

    return types.intp(types.intp), generate


def _assume_below(builder: Any, number: Any, limit: int) -> None:
    flag = ir.IntType(1)
    assume = builder.module.declare_intrinsic("llvm.assume", (), ir.FunctionType(ir.VoidType(), [flag]))
    builder.call(assume, [builder.icmp_unsigned("<", number, ir.Constant(ir.IntType(64), limit))])


def _make_fma(_typing: Any, a: Any, b: Any, c: Any) -> Any:
    """``a * b + c``, rounded once; in single precision if all three are."""
    kind = types.float32 if a == b == c == types.float32 else types.float64

    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return kind(kind, kind, kind), generate


def _make_fast_divider(_typing: Any) -> Any:
    """Whether the processor computes square roots about as fast as :func:`square_root`, beside other arithmetic, as AMD's do.

    Eight square roots take 8 cycles on Zen 5 and up to 24 on Golden Cove. LLVM drops the code that is not used.
    """

    def generate(context: Any, _builder: Any, _signature: Any, _arguments: Any) -> Any:
        _, processor, _ = context.codegen().magic_tuple()  # numba's cache has kernels apart by these three
        return context.get_constant(types.boolean, processor.startswith("znver"))

    return types.boolean(), generate


def _make_bits(_typing: Any, _x: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), generate


def _make_number(_typing: Any, _of: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), generate


wide = cast("Callable[[], None]", intrinsic(_make_wide))
lane_count = cast("Callable[[int], int]", intrinsic(_make_lane_count))
as_lane = cast("Callable[[int], int]", intrinsic(_make_as_lane))
fma = cast("Callable[[float, float, float], float]", intrinsic(_make_fma))
fast_divider = cast("Callable[[], bool]", intrinsic(_make_fast_divider))
_bits = cast("Callable[[float], int]", intrinsic(_make_bits))
_number = cast("Callable[[int | np.int64], float]", intrinsic(_make_number))


@njit(**ALLOCATING)
def zeros(size: int, kind: Any = np.float64) -> Any:
    """Zeros whose address is a multiple of 64 bytes, so that no vector crosses a cache line: reading them takes half the time."""
    block = np.zeros(size + 16, kind)
    start = -block.ctypes.data % 64 // block.itemsize
    return block[start : start + size]


@njit(**ALLOCATING)
def copied(values: Any) -> Any:
    """A copy, aligned like :func:`zeros`."""
    copy = zeros(values.size)
    for i in range(values.size):
        copy[i] = values[i]
    return copy


@njit(**INLINE)
def square_root(x: float) -> float:
    """Square root of 0 or of a number from 2**-968 on, correctly rounded: the bits are those of the processor's own square root.

    Half the exponent gives 0.79 / sqrt(x) to some per cent, a Newton step with matching constants [1]_ ``root`` = sqrt(x) and ``half`` =
    0.5 / sqrt(x) to 9e-4, and the series of ``(1 - 2 e)**-0.5`` the rest of both, to 9e-16. Then the remainder ``x - root**2``, which has
    no rounding error where it matters, corrects the last bits [2]_. The coefficients are fitted so that this also rounds the numbers
    correctly whose roots lie nearest to the middle of two floating-point numbers; ``tests/gen/physics/kernel/test_root_laws.py`` lists
    all of them.

    .. [1] L. Moroz et al., "Fast calculation of inverse square root with the use of magic constant: analytical approach", *Appl. Math.
           Comput.* 316 (2018) 245-255.
    .. [2] P. W. Markstein, "Computation of elementary functions on the IBM RISC System/6000 processor", *IBM J. Res. Dev.* 34 (1990)
           111-119.
    """
    y = _number(0x5FE16642D6CC1867 - (_bits(x) >> 1))
    rough = x * y
    stretch = fma(-rough, y, 1.8909909805192777)
    root = rough * stretch
    half = _number(_bits(y) - (1 << 52)) * stretch
    e = fma(-root, half, 0.5)
    series = fma(e, fma(e, fma(e, 4.373618657742179, 2.5000078852955396), 1.5000000009629106), 0.9999999999983447)
    more = e * series
    root, half = fma(root, more, root), fma(half, more, half)
    return fma(fma(-root, root, x), half, root)


@njit(**INLINE)
def ninth_root(x: float) -> float:
    """Ninth root of 0 or of a number from 1e-300 on, to 1e-14 of its value, without a root or a division.

    A ninth of the exponent gives ``y = x**(-1/9)`` to 3 %. With ``e = 1 - x y**9``, two steps multiply it by the series of
    ``(1 - e)**(-1/9)``.
    """
    x = max(x, 1e-300)
    exponent = np.int32(1191820569.0 - float(np.int32(_bits(x) >> 32)) * (1 / 9))
    y = _number(np.int64(exponent) << 32)
    e = fma(-x, _ninth_power(y), 1.0)
    y = fma(y * e, fma(e, fma(e, 95 / 2187, 5 / 81), 1 / 9), y)
    e = fma(-x, _ninth_power(y), 1.0)
    y = fma(y * e, fma(e, fma(e, fma(e, 665 / 19683, 95 / 2187), 5 / 81), 1 / 9), y)
    square = y * y
    fourth = square * square
    return x * (fourth * fourth)


@njit(**INLINE)
def _ninth_power(x: float) -> float:
    cube = x * x * x
    return cube * cube * cube


@njit(**INLINE)
def root(x: float) -> float:
    """Square root in hardware where that is fast, in software elsewhere; the bits are the same."""
    if fast_divider():
        return math.sqrt(x)
    return square_root(x)


@njit(**INLINE)
def sine(x: float) -> float:
    """Sine of an angle below 0.8 rad, to 1e-11 of its value; a polynomial, because a call would keep the loop over lanes scalar."""
    y = x * x
    tail = fma(y, fma(y, fma(y, fma(y, -1 / 39916800, 1 / 362880), -1 / 5040), 1 / 120), -1 / 6)
    return fma(x * y, tail, x)


@njit(**INLINE)
def cosine(x: float) -> float:
    """Cosine of an angle up to pi/2, to 2e-13."""
    y = x * x
    tail = fma(y, fma(y, fma(y, -1 / 6402373705728000, 1 / 20922789888000), -1 / 87178291200), 1 / 479001600)
    return fma(y, fma(y, fma(y, fma(y, fma(y, fma(y, tail, -1 / 3628800), 1 / 40320), -1 / 720), 1 / 24), -1 / 2), 1.0)
