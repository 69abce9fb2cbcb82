"""The kernel of this machine: whether it is compiled, and how it is loaded."""

import functools
from typing import Any

import numba
import numpy as np

from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate_lanes
from gen.physics.kernel.layout import Batch, Shape
from gen.support.garbage import keep_garbage
from gen.support.kernel_cache import is_on_disk

DIMENSIONS = {"schedule": 3, "tables": 2}
"""Dimensions of the arrays of a batch that have more than one."""

_kernel: Any = integrate_lanes


def is_compiled() -> bool:
    """Whether the kernel is loaded or on disk."""
    return signature() in _kernel.overloads or is_on_disk(_kernel, signature())


def load_kernel() -> None:
    """Load the kernel, or compile it if it is not on disk."""
    if signature() not in _kernel.overloads:
        with keep_garbage():
            _kernel.compile(signature())


@functools.cache
def signature() -> tuple[Any, ...]:
    """Types of the arguments of the kernel."""
    arrays = Batch(1, *(np.empty((0,) * DIMENSIONS.get(field, 1)) for field in Batch._fields[1:]))
    return tuple(numba.typeof(argument) for argument in (Shape(1, 1), arrays, 1e-5, 1, decimation(1), 0, 1))
