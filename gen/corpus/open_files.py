"""Files of records that are open: a limited number of them, each with the datasets that have been checked.

Files are opened by path, so that their readers can be pickled, sent to dask workers and shared with forked processes.
"""

import os
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import netCDF4  # noqa: F401 - tells HDF5 where its zstd filter is

from gen.corpus.files import Stamp, stamp
from gen.corpus.hdf5 import LIBRARY_LOCK, own_dataset
from gen.corpus.layout import Packing, attributes_of, checked_shape, is_deflated, packing_of
from gen.corpus.schema import SIGNAL
from gen.support.errors import CorpusError

MOST_OPEN = 64
"""Largest number of open files. A process can open 256 or more; closing one file and opening another takes 0.4 ms."""


class Source(NamedTuple):
    """Path of a file, and its stamp when it was checked."""

    path: str
    stamp: Stamp


class StoredSignal(NamedTuple):
    """Signal of a file after its check; h5py reads shape, attributes and filters anew each time."""

    dataset: h5py.Dataset
    shape: tuple[int, int, int]
    packing: Packing
    deflated: bool
    """Whether the chunks are streams for :func:`gen.corpus.part.inflated`."""


class OpenFile(NamedTuple):
    """Handle of a file, and its datasets that have been checked."""

    handle: h5py.File
    checked: dict[str, h5py.Dataset]
    signals: dict[str, StoredSignal]

    def dataset(self, name: str) -> h5py.Dataset:
        """Dataset whose values are in this file."""
        if name not in self.checked:
            self.checked[name] = own_dataset(self.handle, name)
        return self.checked[name]

    def signal(self) -> StoredSignal:
        """Signal of an allowed shape, type and packing."""
        if SIGNAL not in self.signals:
            stored = own_dataset(self.handle, SIGNAL)
            self.signals[SIGNAL] = StoredSignal(stored, checked_shape(stored), packing_of(stored), is_deflated(stored))
        return self.signals[SIGNAL]


_open_files: OrderedDict[Source, OpenFile] = OrderedDict()
_opened_by = os.getpid()
"""Process that opened the files. A forked process closes them and opens its own."""


def source_of(path: Path | str) -> Source:
    """Path and present stamp of a file; CorpusError if there is no file."""
    try:
        return Source(str(Path(path).absolute()), stamp(path))
    except OSError as error:
        raise CorpusError(
            f"{path}: not a readable file of a corpus ({error.strerror}); make or copy it again."
        ) from None


@contextmanager
def open_source(source: Source) -> Iterator[OpenFile]:
    """Open file of a source, under the lock of the libraries; all their errors become a CorpusError."""
    with LIBRARY_LOCK:
        try:
            yield _open_file(source)
        except CorpusError:
            raise
        except Exception as error:  # h5py raises a dozen unrelated types on damaged bytes
            reason = (str(error) or type(error).__name__).splitlines()[0]
            if isinstance(error, KeyError):  # of a name, or of h5py with a sentence
                reason = str(error.args[0]) if " " in str(error.args[0]) else f"it has no variable {error.args[0]}"
            raise CorpusError(
                f"{source.path}: not a readable file of a corpus ({reason}); make or copy it again."
            ) from error


def _open_file(source: Source) -> OpenFile:
    """Open file of a source; if too many are open, the least recently used one is closed."""
    global _opened_by
    if _opened_by != os.getpid():
        while _open_files:
            _open_files.popitem()[1].handle.close()
        _opened_by = os.getpid()
    if stamp(source.path) != source.stamp:
        raise CorpusError(f"{source.path}: changed since the corpus was opened; open the corpus again.")
    if source not in _open_files:
        while len(_open_files) >= MOST_OPEN:
            _open_files.popitem(last=False)[1].handle.close()
        _open_files[source] = OpenFile(h5py.File(source.path, "r", locking=False), {}, {})
    _open_files.move_to_end(source)
    return _open_files[source]


def close(sources: Sequence[Source]) -> None:
    """Close files that are open."""
    with LIBRARY_LOCK:
        for source in sources:
            if source in _open_files:
                _open_files.pop(source).handle.close()


def file_facts(path: Path) -> tuple[dict[str, Any], tuple[int, int, int]]:
    """Global attributes of a file of records, and the shape of its signal; CorpusError if it is none."""
    source = source_of(path)
    with open_source(source) as file:
        facts = attributes_of(file.handle), file.signal().shape
    close([source])  # another library cannot open a file that is open here
    return facts
