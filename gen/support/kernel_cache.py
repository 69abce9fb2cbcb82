"""Compiled kernels on disk: numba's cache, in files that processes can write at the same time and that show whether they are damaged.

Compiled functions are kept in the folder of the environment variable NUMBA_CACHE_DIR, else in the cache folder of the user, else in
``__pycache__`` beside the source. Numba looks for changes in the file of a function alone, not in those of the functions that it calls. It
fails on a damaged file [1]_, and two processes that compile variants of a function at the same time can give both the same file [2]_. So
each variant has a file of its own here, which begins with a hash of sources, types and content; any other file counts as missing and is
replaced.

.. [1] https://github.com/numba/numba/issues/10128
.. [2] https://github.com/numba/numba/issues/4807
"""

import pickle
from contextlib import suppress
from hashlib import sha256
from typing import Any

import numba
import numba.core.config
from numba.core.caching import FunctionCache, IndexDataCacheFile
from platformdirs import user_cache_dir

_config: Any = numba.core.config  # its names are made when it is loaded

_HASH_BYTES = 32


class _VariantFiles(IndexDataCacheFile):
    """One file for each variant of a function, in place of numba's index and numbered files."""

    def save(self, key: Any, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(self._path(key)) as file:  # written under another name, then renamed
            file.write(self._hash(key, content) + content)

    def load(self, key: Any) -> Any:
        with suppress(OSError), open(self._path(key), "rb") as file:  # noqa: PTH123 - the pure core imports no pathlib
            stored, content = file.read(_HASH_BYTES), file.read()
            if stored == self._hash(key, content):
                return pickle.loads(content)  # noqa: S301 - this machine wrote it
        return None

    def _path(self, key: Any) -> str:
        return self._data_path(self._data_name(int(sha256(repr(key).encode()).hexdigest()[:16], 16)))

    def _hash(self, key: Any, content: bytes) -> bytes:
        return sha256(repr((self._source_stamp, key)).encode() + content).digest()


class _KernelCache(FunctionCache):
    """Numba's cache of one function, whose ``sources`` have a hash."""

    def __init__(self, dispatcher: Any, sources: str) -> None:
        chosen = _config.CACHE_DIR
        # files beside the sources would stay when the package is removed, and hide one that is installed elsewhere
        _config.CACHE_DIR = chosen or user_cache_dir("raceway")
        try:
            super().__init__(dispatcher.py_func)
        finally:
            _config.CACHE_DIR = chosen
        stamp = numba.__version__, sources, self._impl.locator.get_source_stamp()
        self._cache_file = _VariantFiles(self.cache_path, self._impl.filename_base, stamp)

    def save_overload(self, sig: Any, data: Any) -> None:
        with suppress(OSError):  # the disk is full: the function stays in memory
            super().save_overload(sig, data)


def keep_on_disk(dispatcher: Any, sources: str) -> Any:
    """Keep the compiled variants of a function on disk, as long as its file and the hash of other ``sources`` are the same.

    They stay in memory alone where no folder can be written.
    """
    with suppress(RuntimeError):  # numba found no folder
        dispatcher._cache = _KernelCache(dispatcher, sources)  # noqa: SLF001 - numba has no public way to name the cache
    return dispatcher


def is_on_disk(dispatcher: Any, types: tuple[Any, ...]) -> bool:
    """Whether a function for arguments of these types is on disk."""
    return dispatcher._cache.load_overload(types, dispatcher.targetctx) is not None  # noqa: SLF001
