"""Helpers of all loops over records: compilation, sums in a fixed order, squares, windows.

Records are rows. Every function takes all rows at once and keeps their precision; no row depends on the others.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
import scipy
from numba import njit
from numpy.typing import DTypeLike, NDArray
from packaging.version import Version

from gen.support.kernel_cache import keep_on_disk
from gen.support.sources import hash_sources

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.floating[Any]]
IntArray = NDArray[np.integer[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]

PARTIAL_SUMS = 16
ROWS_TOGETHER = Version(scipy.__version__) < Version("1.18")


def on_disk(kernel: Any) -> Any:
    """Keep a compiled loop over records on disk, as long as its file and this package are the same."""
    return keep_on_disk(kernel, hash_sources("features/signal"))


def row_kernel(function: Callable[..., Any]) -> Any:
    """Compile a loop over records, which runs without the interpreter lock, and keep it on disk.

    Without "reassoc", with which cached and freshly compiled code differed in the last bit.
    """
    return on_disk(njit(nogil=True, error_model="numpy", fastmath={"nnan", "nsz"})(function))


@row_kernel
def total(values: FloatArray) -> float:
    """Sum in double precision in a fixed order, as 16 partial sums that fit vector registers."""
    return total_with(values, np.empty(PARTIAL_SUMS))


@row_kernel
def total_with(values: FloatArray, parts: FloatArray) -> float:
    """`total` with given memory for the partial sums: of short rows, allocating it takes half of the time."""
    parts[:] = 0.0
    whole = len(values) // PARTIAL_SUMS * PARTIAL_SUMS
    for start in range(0, whole, PARTIAL_SUMS):
        for part in range(PARTIAL_SUMS):
            parts[part] += values[start + part]
    result = 0.0
    for part in range(PARTIAL_SUMS):
        result += parts[part]
    for i in range(whole, len(values)):
        result += values[i]
    return result


@row_kernel
def centre(x: FloatArray) -> FloatArray:
    """Records without their mean, in single precision, shape (record, time)."""
    out = np.empty(x.shape, np.float32)
    for row in range(len(x)):
        mean = total(x[row]) / x.shape[1]
        for i in range(x.shape[1]):
            out[row, i] = x[row, i] - mean
    return out


@row_kernel
def squared_modulus(z: ComplexArray) -> FloatArray:
    """Squared modulus, shape (record, time) or (record, frequency) as the argument."""
    out = np.empty(z.shape, z.real.dtype)
    for row in range(z.shape[0]):
        for i in range(z.shape[1]):
            out[row, i] = z[row, i].real ** 2 + z[row, i].imag ** 2
    return out


@lru_cache(32)
def hann_window(n: int, dtype: DTypeLike) -> FloatArray:
    """Periodic Hann window, shape (time,)."""
    return (0.5 + 0.5 * np.cos(np.linspace(-np.pi, np.pi, n + 1)))[:-1].astype(dtype)


def by_row(transform: Callable[..., Any], z: ComplexArray, n: int, norm: str | None = None) -> ComplexArray:
    """Complex transform to ``n`` points, row by row if SciPy rounds several rows in single precision otherwise than one."""
    if ROWS_TOGETHER:
        return np.asarray(transform(z, n, axis=-1, norm=norm))
    out = np.empty((len(z), n), z.dtype)
    for row, values in enumerate(z):
        out[row] = transform(values, n, norm=norm)
    return out


def group_means(values: FloatArray, group: IntArray) -> FloatArray:
    """`mean_row` of the rows of each group, in the order of their numbers, shape (record, feature) to (group, feature)."""
    order = np.argsort(group, kind="stable")
    _, first = np.unique(group[order], return_index=True)
    return np.stack([mean_row(rows) for rows in np.split(values[order], first[1:])])


def mean_row(values: FloatArray) -> FloatArray:
    """Mean of each feature over the records that have it, NaN without any; the order of the records has no effect."""
    values = np.sort(values, axis=0)  # NaN comes last
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def brief(result: Any) -> str:
    """Text of a named tuple with the shapes of its arrays in place of their values.

    >>> from collections import namedtuple
    >>> brief(namedtuple("Spectrum", "level, fs")(np.zeros((2, 3)), 5.0))
    'Spectrum(level: (2, 3), fs: 5.0)'
    """
    told = (f"{name}: {np.shape(value) or value}" for name, value in result._asdict().items())
    return f"{type(result).__name__}({', '.join(told)})"
