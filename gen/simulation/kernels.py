"""Kernels compiled once per machine: the first process that needs one compiles it, the others wait and load it.

Numba keeps compiled kernels in a folder: that of the environment variable NUMBA_CACHE_DIR, else ``__pycache__`` beside the source, else one
of the user. While a process compiles a kernel, it holds the lock of a file in that folder. The system releases the lock when the process
ends, however it ends. Where no such file can be made or locked, processes may compile the same kernel at once: slower, and harmless.
"""

import fcntl
import functools
import os
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core.caching import FunctionCache

from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate_lanes
from gen.physics.kernel.layout import Batch, Shape
from gen.support.garbage import keep_garbage

DIMENSIONS = {"schedule": 3, "tables": 2, "strikes": 3}
"""Dimensions of the arrays of a batch that have more than one."""


class SharedCache(FunctionCache):
    """Numba's cache on disk of one function, for several processes that compile it at the same time."""

    def __init__(self, dispatcher: Any) -> None:
        super().__init__(dispatcher.py_func)
        self._dispatcher = dispatcher
        dispatcher._cache = self  # noqa: SLF001 - numba has no public way to name the cache of a function

    def load(self, types: tuple[Any, ...]) -> None:
        """Load the function for arguments of these types; if it is not on disk, compile it, unless another process does so already."""
        with nullcontext() if self.has(types) else lock_file(self._lock_of(types)), keep_garbage():
            self._dispatcher.compile(types)  # numba looks on disk first

    def has(self, types: tuple[Any, ...]) -> bool:
        """Whether the function for arguments of these types is on disk."""
        name = self._cache_file._load_index().get(self._key(types))  # noqa: SLF001
        return name is not None and (Path(self.cache_path) / name).exists()

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save the function that was compiled; without an error if the disk is full.

        Numba reads the index, adds the function and writes it back: of two processes that do so at once one would lose its function, or
        both would write the same file.
        """
        with lock_file(Path(self.cache_path) / "index.lock"), suppress(OSError):
            super().save_overload(sig, data)

    def _key(self, types: tuple[Any, ...]) -> Any:
        """Types, processor and source, as numba identifies a compiled function."""
        return self._index_key(types, self._dispatcher.targetctx.codegen())

    def _lock_of(self, types: tuple[Any, ...]) -> Path:
        return Path(self.cache_path) / f"{sha256(repr(self._key(types)).encode()).hexdigest()[:16]}.lock"


_kernel: Any = integrate_lanes
_on_disk = None if _kernel.stats.cache_path is None else SharedCache(_kernel)


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
    arrays = Batch(*(np.empty((0,) * DIMENSIONS.get(field, 1)) for field in Batch._fields))
    return tuple(numba.typeof(argument) for argument in (shape, arrays, 1e-5, 1, decimation(1), 0, 1))


@contextmanager
def lock_file(path: Path) -> Iterator[None]:
    """Hold the lock of a file, once no other process holds it; hold none if the file cannot be made or locked."""
    try:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError:
        yield
        return
    try:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)
