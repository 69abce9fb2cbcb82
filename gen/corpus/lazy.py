"""Records of a corpus as an xarray Dataset that is read when it is used: the one way in which files of records are read.

Arrays hold paths instead of handles, so they can be pickled, sent to dask workers and shared with forked processes. A limited number of
files is open in each process.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property, lru_cache
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import xarray as xr
from numpy.typing import NDArray
from xarray.backends import BackendArray
from xarray.core import indexing

from gen.corpus.disk import Stamp, has_whole_bytes, stamp
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS, class_names, with_own_codes
from gen.corpus.trust import (
    attributes_of,
    is_bare_dimension,
    is_text,
    library_errors,
    open_trusted,
    own_dataset,
    packing_of,
    read_values,
)
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

MOST_OPEN = 24
"""Largest number of files that are open for lazy arrays. A process can open 256 or more; an open file holds 4 MB."""


_BLOCK_RECORDS, _BLOCK_SAMPLES = 256, 10_000_000


class Source(NamedTuple):
    """Path of a file, and its stamp when it was checked."""

    path: str
    stamp: Stamp


class _File:
    """Open file of a source; it is closed when it leaves the cache."""

    def __init__(self, source: Source) -> None:
        self.file = open_trusted(source.path)

    @cached_property
    def variables(self) -> dict[str, h5py.Dataset]:
        """All variables by name, except the signal."""
        stored = {name: own_dataset(self.file, name) for name in map(str, self.file) if name != SIGNAL}
        return {name: variable for name, variable in stored.items() if not is_bare_dimension(variable)}

    @cached_property
    def signal(self) -> tuple[h5py.Dataset, tuple[Any, ...]]:
        """Signal with its shape, type and packing, all of which take longer to read than a record."""
        stored = own_dataset(self.file, SIGNAL)
        return stored, (stored.shape, _type_of(stored), f"{packing_of(stored)}")  # in a text NaN equals NaN


_open_file = lru_cache(MOST_OPEN)(_File)


def close_files() -> None:
    """Close all files; a lazy array opens its own again when it is read."""
    with library_errors(""):
        _open_file.cache_clear()


if hasattr(os, "register_at_fork"):  # Windows has no fork
    os.register_at_fork(after_in_child=_open_file.cache_clear)


@contextmanager
def _opened(source: Source) -> Iterator[_File]:
    """Open file of a source, under the lock of the libraries; all their errors become a CorpusError."""
    with library_errors(source.path):
        now = stamp(source.path)
        # a change of permissions or links alters no byte
        if now != source.stamp and (now[:2] != source.stamp[:2] or not has_whole_bytes(Path(source.path))):
            raise CorpusError(f"{source.path}: changed since the corpus was opened; open the corpus again.")
        yield _open_file(source)


class _Stored(BackendArray):
    """Values of a variable in consecutive files: numbers as they are stored, and texts decoded."""

    def __init__(
        self, name: str, sources: Sequence[Source], counts: Sequence[int], row: tuple[int, ...], dtype: np.dtype[Any]
    ) -> None:
        self.name, self.sources = name, tuple(sources)
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        self.shape, self.dtype = (int(self.starts[-1]), *row), dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> NDArray[Any]:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[int | slice | NDArray[np.integer[Any]], ...]) -> NDArray[Any]:
        """Read runs of consecutive records of a file in one call each, the channels from the first to the last, and all samples."""
        record, *channels = map(_places, key[:2], self.shape[:2])
        records = np.atleast_1d(record)
        spans = [slice(int(np.min(of, initial=self.shape[1])), int(np.max(of, initial=-1)) + 1) for of in channels]
        widths = [max(0, span.stop - span.start) for span in spans]
        values = np.empty((len(records), *widths, *self.shape[2:]), self.dtype)
        parts = np.searchsorted(self.starts, records, side="right") - 1
        ends = np.flatnonzero((np.diff(records) != 1) | (np.diff(parts) != 0)) + 1
        for first, stop in zip([0, *ends], [*ends, len(records)], strict=True):
            if values[first:stop].size:
                start = int(records[first] - self.starts[parts[first]])
                values[first:stop] = self._of_file(int(parts[first]), slice(start, start + stop - first), *spans)
        for of, span in zip(channels, spans, strict=True):
            if not np.array_equal(of, np.arange(span.start, span.stop)):
                values = values[:, of - span.start]
        values = values[(..., *key[2:])]
        return values if record.ndim else values[0]

    def _of_file(self, place: int, records: slice, *_: slice) -> NDArray[Any]:
        with _opened(self.sources[place]) as opened:
            stored = opened.variables[self.name]
            values = read_values(stored, records)
            if is_text(stored):
                rows = np.ascontiguousarray(values).view(f"S{values.shape[1]}")[:, 0]
                values = np.char.decode(rows, "utf-8")
            return values.astype(_type_of(stored), copy=False)


def _places(key: int | slice | NDArray[np.integer[Any]], size: int) -> NDArray[np.integer[Any]]:
    """Places of the items that a key selects from ``size`` items."""
    return np.arange(*key.indices(size)) if isinstance(key, slice) else np.asarray(key) % max(1, size)


class _Signal(_Stored):
    """Signal of consecutive parts: counts of the converter, or accelerations."""

    packing: str
    """Packing of the first part."""

    def _of_file(self, place: int, records: slice, *channels: slice) -> NDArray[Any]:
        with _opened(self.sources[place]) as opened:
            stored, kind = opened.signal
            shape = (self.starts[place + 1] - self.starts[place], *self.shape[1:])
            if kind != (shape, self.dtype, self.packing):
                raise CorpusError(
                    f"{self.sources[place].path}: its signal has another shape or type than the corpus; do not trust this corpus."
                )
            return read_values(stored, records, *channels)


def stored_records(
    described: Sequence[Path], parts: Sequence[Path] | None = None, counts: Sequence[int] | None = None
) -> xr.Dataset:
    """Records as they are stored, read lazily: the per-record variables of the files ``described`` with the signal of ``parts``.

    ``described`` is the index of the parts, or the parts themselves; these are meant without ``parts``. ``counts`` are the numbers of
    records of the parts; without them there is one part. Nothing that is read is kept.

    Raises
    ------
    CorpusError
        If a file is missing or does not pass :func:`gen.corpus.trust.open_trusted`.
    """
    sources, of_signal = ([_source(path) for path in paths] for paths in (described, parts or described))
    with _opened(of_signal[0]) as opened:
        stored, ((records, *row), dtype, packing) = opened.signal
        attributes = attributes_of(stored)
    signal = _Signal(SIGNAL, of_signal, [records] if counts is None else counts, tuple(row), dtype)
    signal.packing = packing
    heads = [_head(source) for source in sources]
    with _opened(sources[-1]) as opened:  # a part names the classes of those before it
        meanings = {name: attributes_of(stored) for name, stored in opened.variables.items()}
        columns = {name: _column(name, sources, heads, of) for name, of in meanings.items()}
        columns[SIGNAL] = xr.Variable(SIGNAL_DIMS, indexing.LazilyIndexedArray(signal), attributes)
        whole = xr.Dataset(columns, attrs=attributes_of(opened.file))
    whole = whole.set_coords([name for name, column in columns.items() if column.dtype.kind == "U"])
    whole.set_close(close_files)
    return whole


def open_records(
    described: Sequence[Path], parts: Sequence[Path] | None = None, counts: Sequence[int] | None = None
) -> xr.Dataset:
    """Records decoded to m s-2 (:func:`stored_records`); a missing sample is NaN, and faults have the codes of this process."""
    stored = with_own_codes(stored_records(described, parts, counts), described[0])
    records = xr.decode_cf(stored, concat_characters=False, decode_times=False, decode_coords=False)
    records.set_close(close_files)
    return records


def blocks_of(records: xr.Dataset) -> list[slice]:
    """Places of all records, in blocks whose signals fit the memory of a task."""
    count, *row = records[SIGNAL].shape
    size = int(np.clip(_BLOCK_SAMPLES // max(1, prod(row)), 1, _BLOCK_RECORDS))
    return [slice(first, min(first + size, count)) for first in range(0, count, size)]


def stored_classes(path: Path) -> dict[int, str]:
    """Names of the fault classes by their codes in a file, which may not be those of this process."""
    return class_names(stored_records([path])["fault"].attrs)


def _source(path: Path) -> Source:
    with library_errors(path):
        return Source(str(path.absolute()), stamp(path))


def _head(source: Source) -> dict[str, tuple[int, np.dtype[Any]]]:
    """Number and type of the values of each variable of a file but its signal."""
    with _opened(source) as opened:
        return {name: (len(stored), _type_of(stored)) for name, stored in opened.variables.items()}


def _type_of(stored: h5py.Dataset) -> np.dtype[Any]:
    """Type of the values of a variable; of text, the number of characters is that of the stored bytes."""
    if not is_text(stored):
        return stored.dtype.newbyteorder("=")
    check_limit("file_bytes", 4 * stored.shape[1], "a text has", ValueError)
    return np.dtype(f"U{max(1, stored.shape[1])}")


def _column(
    name: str,
    sources: Sequence[Source],
    heads: Sequence[dict[str, tuple[int, np.dtype[Any]]]],
    attributes: dict[str, Any],
) -> xr.Variable:
    """Per-record variable of consecutive files, or an axis of the first; a text is as wide as the longest of any file."""
    axis = name in SIGNAL_DIMS
    counts, types = zip(*(head[name] for head in (heads[:1] if axis else heads)), strict=True)
    stored = _Stored(name, sources, counts, (), max(types, key=lambda dtype: dtype.itemsize))
    encoding = {"dtype": "S1", "char_dim_name": f"{name}_length"} if stored.dtype.kind == "U" else {}
    return xr.Variable(name if axis else "record", indexing.LazilyIndexedArray(stored), attributes, encoding)
