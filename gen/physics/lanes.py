"""How the kernels are compiled: one record per lane, the same bits on every machine with FMA.

``reassoc`` would let a sum depend on the width of the vectors, ``nnan`` and ``ninf`` would hide a diverged state: all three are out.
What differs between compiled variants is passed as the *length of a tuple*: lengths are part of a type, so numba compiles one kernel
per combination and finds it again in its cache on disk, which it could not for functions built inside functions.
"""

from typing import Any

from numba import njit

LANES = 32  # records advanced side by side; below 16 LLVM keeps the loop scalar

FASTMATH = {"nsz", "arcp", "contract", "afn"}
INLINE: dict[str, Any] = {"forceinline": True, "fastmath": FASTMATH, "error_model": "numpy"}
# For short loops over lanes, which LLVM unrolls: of two products in a sum it may fuse one in the first lanes and the other in the rest.
UNFUSED: dict[str, Any] = {**INLINE, "fastmath": FASTMATH - {"contract"}}
# All the rest is inlined into it: a function left on its own is optimised apart in the process that compiles the kernel, and that process
# would give other last bits than those that find the kernel in the cache.
KERNEL: dict[str, Any] = {"fastmath": FASTMATH, "error_model": "numpy", "nogil": True, "cache": True}


@njit(**INLINE)
def sine(x: float) -> float:
    """Sine of an angle below 0.8 rad, to 1e-11 of its value: a polynomial, since a call would keep the loop over lanes scalar."""
    y = x * x
    return x * (1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110)))))


@njit(**INLINE)
def cosine(x: float) -> float:
    """Cosine of an angle up to pi/2, to 2e-13."""
    y = x * x
    tail = 1 - y / 132 * (1 - y / 182 * (1 - y / 240 * (1 - y / 306)))
    return 1 - y / 2 * (1 - y / 12 * (1 - y / 30 * (1 - y / 56 * (1 - y / 90 * tail))))
