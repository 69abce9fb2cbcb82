"""What the loops over records share: how they are compiled, sums in a fixed order, squares, windows.

Records are rows: every function works on all of them at once, in the precision it is given, and no row knows of the others.
"""

from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import DTypeLike, NDArray
from scipy.signal.windows import hann

FloatArray = NDArray[np.floating[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]

row_kernel = njit(cache=True, error_model="numpy", fastmath={"nnan", "nsz"})
"""Compiles a loop over records. Not with "reassoc": code from the cache then differed in a last bit from code just compiled."""

PARTIAL_SUMS = 16


@row_kernel
def total(values: FloatArray) -> float:
    """Sum in double precision, in parts that a processor adds at once and in an order that is always the same."""
    parts = np.zeros(PARTIAL_SUMS)
    whole = len(values) // PARTIAL_SUMS * PARTIAL_SUMS
    for start in range(0, whole, PARTIAL_SUMS):
        for part in range(PARTIAL_SUMS):
            parts[part] += values[start + part]
    found = 0.0
    for part in range(PARTIAL_SUMS):
        found += parts[part]
    for i in range(whole, len(values)):
        found += values[i]
    return found


@row_kernel
def centred(x: FloatArray) -> FloatArray:
    """Records less their mean, in single precision, shape (record, time)."""
    out = np.empty(x.shape, np.float32)
    for row in range(len(x)):
        mean = total(x[row]) / x.shape[1]
        for i in range(x.shape[1]):
            out[row, i] = x[row, i] - mean
    return out


@row_kernel
def squared_modulus(z: ComplexArray) -> FloatArray:
    """Square of the modulus, in the shape (record, time) or (record, frequency) of its argument."""
    out = np.empty(z.shape, z.real.dtype)
    for row in range(z.shape[0]):
        for i in range(z.shape[1]):
            out[row, i] = z[row, i].real ** 2 + z[row, i].imag ** 2
    return out


@lru_cache(32)
def hann_window(n: int, dtype: DTypeLike) -> FloatArray:
    """Periodic Hann window, shape (time,)."""
    return hann(n, sym=False).astype(dtype)
