"""Compiled kernels on disk, for several processes: kept under the hash of their sources, and compiled again if a file is damaged.

Numba keeps compiled functions in a folder: that of the environment variable NUMBA_CACHE_DIR, else ``__pycache__`` beside the source, else
one of the user. It looks for changes in the file of a function alone, not in those of the functions that it calls, and fails on a damaged
file. While a process compiles a kernel, or adds it to the index, it holds the lock of a file in that folder. Where no such file can be
made or locked, processes may compile the same kernel at once: slower, and harmless.
"""

import pickle
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from hashlib import sha256
from typing import Any

import numba
from filelock import FileLock
from numba.core.caching import FunctionCache, IndexDataCacheFile

from gen.support.garbage import keep_garbage

_HASH_BYTES = 32


class _WholeFiles(IndexDataCacheFile):
    """Files that begin with a hash of sources and content; a file with another hash, or of another kernel, counts as missing."""

    def save(self, key: Any, data: Any) -> None:
        super().save(key, (key, data))

    def load(self, key: Any) -> Any:
        stored, data = super().load(key) or (None, None)
        return data if stored == key else None

    def _dump(self, obj: Any) -> bytes:
        content = super()._dump(obj)
        return self._hash(content) + content

    def _hash(self, content: bytes) -> bytes:
        return sha256(repr(self._source_stamp).encode() + content).digest()

    def _read(self, path: str) -> Any:
        with open(path, "rb") as file:  # noqa: PTH123 - without pathlib, as all that the pure core imports
            stored, content = file.read(_HASH_BYTES), file.read()
        if stored != self._hash(content):
            raise FileNotFoundError(f"{path}: is damaged, or of other sources")
        return pickle.loads(content)  # noqa: S301 - this machine wrote it

    def _load_index(self) -> dict[Any, str]:
        try:
            return self._read(self._index_path)
        except OSError:
            return {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        with self._open_for_write(self._index_path) as file:
            file.write(self._dump(overloads))

    def _load_data(self, name: str) -> Any:
        return self._read(self._data_path(name))


class KernelCache(FunctionCache):
    """Numba's cache on disk of one function, for several processes that compile it at the same time."""

    def __init__(self, dispatcher: Any, sources: str) -> None:
        super().__init__(dispatcher.py_func)
        stamp = numba.__version__, sources, self._impl.locator.get_source_stamp()
        self._cache_file = _WholeFiles(self.cache_path, self._impl.filename_base, stamp)
        self._dispatcher = dispatcher

    def load(self, types: tuple[Any, ...]) -> None:
        """Load the function for arguments of these types; if it is not on disk, compile it, unless another process does so already."""
        with ExitStack() as held:
            if not self.has(types):
                held.enter_context(self._lock(sha256(repr(self._key(types)).encode()).hexdigest()[:16]))
            held.enter_context(keep_garbage())
            self._dispatcher.compile(types)  # numba looks on disk first

    def has(self, types: tuple[Any, ...]) -> bool:
        """Whether the function for arguments of these types is on disk."""
        return self._cache_file.load(self._key(types)) is not None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save the function that was compiled; without an error if the disk is full.

        Numba reads the index, adds the function and writes it back: of two processes that do so at once one would lose its function, or
        both would write the same file.
        """
        with self._lock("index"), suppress(OSError):
            super().save_overload(sig, data)

    def _key(self, types: tuple[Any, ...]) -> Any:
        """Types and processor, as numba identifies a compiled function."""
        return self._index_key(types, self._dispatcher.targetctx.codegen())

    @contextmanager
    def _lock(self, name: str) -> Iterator[None]:
        with ExitStack() as held:
            with suppress(OSError):
                held.enter_context(FileLock(f"{self.cache_path}/{name}.lock"))
            yield


def keep_on_disk(dispatcher: Any, sources: str) -> Any:
    """Keep the compiled variants of a function on disk, as long as its file and the hash of other ``sources`` are the same.

    They stay in memory alone where no folder can be written.
    """
    with suppress(RuntimeError):  # numba found no folder
        dispatcher._cache = KernelCache(dispatcher, sources)  # noqa: SLF001 - numba has no public way to name the cache
    return dispatcher
