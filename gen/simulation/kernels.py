"""The kernels of this machine by their shapes: whether they are compiled, and where they are kept."""

import functools
from pathlib import Path
from typing import Any

import numba
import numpy as np

from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate_lanes
from gen.physics.kernel.layout import Batch, Shape
from gen.support.kernels import KernelCache

DIMENSIONS = {"schedule": 3, "tables": 2}
"""Dimensions of the arrays of a batch that have more than one."""

_kernel: Any = integrate_lanes
_on_disk: KernelCache | None = _kernel._cache if _kernel.stats.cache_path is not None else None  # noqa: SLF001


def cache_folder() -> Path | None:
    """Folder of the compiled kernels; None if none can be written."""
    return None if _on_disk is None else Path(_on_disk.cache_path)


def is_compiled(shape: Shape) -> bool:
    """Whether the kernel of a shape is loaded or on disk."""
    types = signature(shape)
    return types in _kernel.overloads or (_on_disk is not None and _on_disk.has(types))


@functools.cache
def load_kernel(shape: Shape) -> None:
    """Load the kernel of a shape, or compile it if neither the disk nor another process has it."""
    if _on_disk is None:
        _kernel.compile(signature(shape))
    elif signature(shape) not in _kernel.overloads:
        _on_disk.load(signature(shape))


@functools.cache
def signature(shape: Shape) -> tuple[Any, ...]:
    """Types of the arguments of the kernel of a shape."""
    arrays = Batch(1, *(np.empty((0,) * DIMENSIONS.get(field, 1)) for field in Batch._fields[1:]))
    return tuple(numba.typeof(argument) for argument in (shape, arrays, 1e-5, 1, decimation(1), 0, 1))
