"""Lazy reading of records from the parts, with a limited number of open files.

All code of the project that reads a corpus uses this module. A signal is read from its part, never through the virtual dataset of
``corpus.nc``: HDF5 keeps all parts of such a dataset open, and returns missing values without an error when it cannot open more files.
Datasets hold paths instead of handles, so they can be pickled, sent to dask workers and shared with forked processes.
"""

import math
import os
import zlib
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import netCDF4  # noqa: F401 - tells HDF5 where its zstd filter is
import numpy as np
import xarray as xr
from numpy.typing import NDArray
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from gen.corpus.files import Stamp, sha256, stamp
from gen.corpus.hdf5 import CRASHES, LIBRARY_LOCK, own_dataset, survives_opening
from gen.corpus.layout import (
    PACKING,
    Packing,
    attributes_of,
    checked_shape,
    is_bare_dimension,
    is_deflated,
    is_text,
    packing_of,
    plain_attributes,
)
from gen.corpus.packed import FILES, PACKED, RECORD_HASH, home_of, packed_part
from gen.corpus.part import inflated
from gen.corpus.part_forms import read_attributes
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS
from gen.errors import CorpusError
from gen.limits import check_limit

MOST_OPEN = 64
"""Largest number of open files. A process can open 256 or more; closing one file and opening another takes 0.4 ms."""

_BLOCK_SAMPLES = 10_000_000


class Source(NamedTuple):
    """Path of a file, and its stamp when it was checked."""

    path: str
    stamp: Stamp


class _OpenFile(NamedTuple):
    """Handle of a file, and its datasets that have been checked."""

    handle: h5py.File
    checked: dict[object, h5py.Dataset]


_open_files: OrderedDict[Source, _OpenFile] = OrderedDict()
_opened_by = os.getpid()
"""Process that opened the files. A forked process closes them and opens its own."""


def source_of(path: Path | str) -> Source:
    """Path and present stamp of a file; CorpusError if there is no file."""
    try:
        return Source(str(Path(path).absolute()), stamp(path))
    except OSError as error:
        raise CorpusError(
            f"{path}: not a readable netCDF-4 part ({error.strerror}); generate or copy it again."
        ) from None


@contextmanager
def _opened(source: Source) -> Iterator[_OpenFile]:
    """Open file of a source, under the lock of the libraries; all their errors become a CorpusError."""
    with LIBRARY_LOCK:
        try:
            yield _open_file(source)
        except CorpusError:
            raise
        except Exception as error:  # h5py raises a dozen unrelated types on damaged bytes
            reason = (str(error) or type(error).__name__).splitlines()[0]
            raise CorpusError(
                f"{source.path}: not a readable netCDF-4 part or index ({reason}); generate or copy it again."
            ) from error


def _open_file(source: Source) -> _OpenFile:
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
        _open_files[source] = _OpenFile(h5py.File(source.path, "r", locking=False), {})
    _open_files.move_to_end(source)
    return _open_files[source]


def _close(sources: Sequence[Source]) -> None:
    with LIBRARY_LOCK:
        for source in sources:
            if source in _open_files:
                _open_files.pop(source).handle.close()


class _Column(BackendArray):
    """Stored values of a per-record variable or of an axis."""

    def __init__(self, source: Source, name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        self.source, self.name, self.shape, self.dtype = source, name, shape, dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> NDArray[Any]:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[int | slice, ...]) -> NDArray[Any]:
        counts = [
            len(range(*item.indices(size))) if isinstance(item, slice) else 1
            for item, size in zip(key, self.shape, strict=True)
        ]
        check_limit(
            "file_bytes", self.dtype.itemsize * math.prod(counts), f"{self.source.path}: {self.name} has", CorpusError
        )
        with _opened(self.source) as file:
            if self.name not in file.checked:
                file.checked[self.name] = own_dataset(file.handle, self.name)
            return np.asarray(file.checked[self.name][key])


class _Signal(BackendArray):
    """Decoded signal (record, channel, elapsed_time) of consecutive parts."""

    def __init__(self, parts: Sequence[Source], counts: Sequence[int], row: tuple[int, int], packing: Packing) -> None:
        self.parts, self.packing = tuple(parts), packing
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        self.shape, self.dtype = (int(self.starts[-1]), *row), packing.decoded

    def __getitem__(self, key: indexing.ExplicitIndexer) -> NDArray[Any]:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[int | slice | NDArray[np.integer[Any]], ...]) -> NDArray[Any]:
        """Read runs of consecutive records of a part in one call, in whole chunks of one record and channel."""
        chosen = [_numbers_of(item, size) for size, item in zip(self.shape, key, strict=True)]
        records, channels, samples = map(np.atleast_1d, chosen)
        parts = np.searchsorted(self.starts, records, side="right") - 1
        ends = np.flatnonzero((np.diff(records) != 1) | (np.diff(parts) != 0)) + 1
        whole = len(samples) == self.shape[2] and bool((np.diff(samples) == 1).all())
        wanted = range(channels[0], channels[0] + 1) if len(channels) == 1 else range(self.shape[1])
        values = np.empty((len(records), len(wanted), self.shape[2]), self.dtype)
        for start, stop in zip([0, *ends], [*ends, len(records)], strict=True):
            if start == stop:
                continue
            first = int(records[start] - self.starts[parts[start]])
            self._decode(int(parts[start]), range(first, first + stop - start), wanted, values[start:stop])
        values = values if len(channels) == 1 else values[:, channels]
        values = values if whole else values[:, :, samples]
        return values.reshape([len(item) for item in chosen if item.ndim])

    def _decode(self, part: int, records: range, channels: range, out: NDArray[Any]) -> None:
        """Decode consecutive records of a part into ``out``. Chunks are inflated without the lock, so that threads run in parallel."""
        with self._stored(part) as stored:
            if not is_deflated(stored):
                self.packing.decode(stored[records.start : records.stop, channels.start : channels.stop], out)
                return
            chunks = _chunks(stored, records, channels)
        inflating = _all_inflated(chunks, self.shape[2], self.parts[part].path)
        for place, counts in zip(np.ndindex(out.shape[:2]), inflating, strict=True):
            self.packing.decode(counts, out[place])

    @contextmanager
    def _stored(self, part: int) -> Iterator[h5py.Dataset]:
        """Stored signal of a part; CorpusError unless it has the shape and packing of the corpus."""
        with _opened(self.parts[part]) as file:
            expected = (int(self.starts[part + 1] - self.starts[part]), *self.shape[1:]), self.packing
            if expected not in file.checked:
                stored = own_dataset(file.handle, SIGNAL)
                if (checked_shape(stored), packing_of(stored)) != expected:
                    raise CorpusError(
                        f"{self.parts[part].path}: its signal has another shape or type than the corpus; do not trust this corpus."
                    )
                file.checked[expected] = stored
            yield file.checked[expected]


def _chunks(stored: h5py.Dataset, records: range, channels: range) -> list[tuple[int, bytes]]:
    """Stored chunks of some records and channels, each with the mask of the filters that were left out."""
    return [stored.id.read_direct_chunk((record, channel, 0)) for record in records for channel in channels]


def _all_inflated(chunks: Sequence[tuple[int, bytes]], samples: int, path: str) -> Iterator[NDArray[np.int16]]:
    """Counts of each chunk; CorpusError if one is damaged."""
    for filters_left_out, chunk in chunks:
        try:
            yield inflated(b"" if filters_left_out else chunk, samples)
        except (ValueError, zlib.error) as error:
            raise CorpusError(f"{path}: damaged ({error}); generate or copy it again.") from None


def _numbers_of(key: int | slice | NDArray[np.integer[Any]], size: int) -> NDArray[np.integer[Any]]:
    """Numbers of the items that a key selects from ``size`` items."""
    if isinstance(key, slice):
        return np.arange(*key.indices(size))
    return np.asarray(key) + size * (np.asarray(key) < 0)


class _Records(BackendEntrypoint):
    """Backend with which xarray opens a part, or an index with its parts."""

    open_dataset_parameters = ("filename_or_obj", "drop_variables", "parts", "counts")

    def open_dataset(  # type: ignore[override]
        self,
        filename_or_obj: Any,
        *,
        drop_variables: Any = None,  # noqa: ARG002 - an argument that xarray passes
        parts: Sequence[Path],
        counts: Sequence[int] | None,
    ) -> xr.Dataset:
        """Variables of one file with the signal of ``parts``; ``counts`` are their numbers of records."""
        source, sources = source_of(filename_or_obj), [source_of(path) for path in parts]
        with _opened(source) as file:
            stored = own_dataset(file.handle, SIGNAL, virtual=counts is not None)
            records, *row = checked_shape(stored)
            found = list(counts) if counts is not None else [records]
            if sum(found) != records:
                raise CorpusError(
                    f"{source.path}: {records} records, the parts hold {sum(found)}; do not trust this corpus."
                )
            packing = packing_of(stored)
            signal = _Signal(sources, found, (row[0], row[1]), packing)
            sizes: dict[str, int] = {"record": records, "channel": row[0], "elapsed_time": row[1]}
            attributes = attributes_of(stored)
            encoding = {name: attributes.pop(name) for name in PACKING if name in attributes}
            attributes.pop("coordinates", None)
            variables, facts = _variables(file, source, sizes), attributes_of(file.handle)
        texts = [name for name, variable in variables.items() if variable.ndim == 2]
        described = xr.decode_cf(xr.Dataset(variables, attrs=facts), decode_times=False).set_coords(texts)
        lazy = indexing.LazilyIndexedArray(signal)
        opened = described.assign(
            {SIGNAL: xr.Variable(SIGNAL_DIMS, lazy, attributes, {"dtype": packing.dtype, **encoding})}
        )
        opened.set_close(partial(_close, (source, *sources)))
        return opened


def open_records(path: Path, parts: Sequence[Path], counts: Sequence[int] | None = None) -> xr.Dataset:
    """Open the per-record variables of ``path`` with the signal of ``parts``, lazily.

    ``counts`` are the numbers of records of the parts if ``path`` is their index; without them ``path`` is a part itself.

    Raises
    ------
    CorpusError
        If a file is missing or unreadable, crashes the library, or has links, values in other files or unknown dimensions.
    """
    if counts is not None and path.is_file() and not survives_opening(str(path), sha256(path), SIGNAL):
        raise CorpusError(f"{path}: {CRASHES}.")
    opened: Any = xr.open_dataset(path, engine=_Records, parts=parts, counts=counts)
    return opened


def open_part(path: Path) -> xr.Dataset:
    """Records of one part, decoded to m s-2 and read lazily. ``path`` can also lead through a packed file (:mod:`gen.corpus.packed`).

    Raises
    ------
    CorpusError
        If the file is missing or is not a part.
    """
    if home_of(path) is None:
        return open_records(path, [path])
    home, place = packed_part(path)
    part = open_records(home, [home]).isel(record=slice(place.first, place.first + place.records))
    part.attrs = read_attributes(place.attributes)
    return part


def read_channel(path: Path, channel: int, names: Sequence[str]) -> tuple[NDArray[np.float32], list[NDArray[Any]]]:
    """Signal of one channel of a part in single precision, shape (record, elapsed_time) [m s-2], and columns by name.

    Features use it: it closes the part, and reads the columns without xarray. Chunks are inflated without the lock, so that threads run in
    parallel.
    """
    source, place = _rows_of(path)
    with _opened(source) as file:
        stored = own_dataset(file.handle, SIGNAL)
        records, _, samples = checked_shape(stored)
        rows = place or range(records)
        packing, deflated = packing_of(stored), is_deflated(stored)
        read: Any = (
            _chunks(stored, rows, range(channel, channel + 1)) if deflated else stored[rows.start : rows.stop, channel]
        )
        columns = [_numbers(own_dataset(file.handle, name), name, records, rows) for name in names]
    if place is None:
        _close([source])  # features read each part once, and an open file holds 1 MB
    if packing.scale is None:
        return read, columns
    signal = np.empty((len(rows), samples), np.float32)
    for row, counts in zip(signal, _all_inflated(read, samples, source.path) if deflated else read, strict=True):
        np.multiply(counts, np.float32(packing.scale), out=row, dtype=np.float32)
        row[counts == packing.fill] = np.nan
    return signal, columns


class StoredBlock(NamedTuple):
    """Consecutive records of a part as they are stored; ``chunks`` are the deflated counts by record and channel, if they are deflated."""

    values: NDArray[Any]
    chunks: list[bytes] | None


def stored_blocks(path: Path) -> Iterator[NDArray[Any]]:
    """Stored signal of a part in blocks of records: counts of the converter, or accelerations [m s-2]."""
    return (block.values for block in blocks_with_chunks(path))


def blocks_with_chunks(path: Path, most_samples: int = _BLOCK_SAMPLES) -> Iterator[StoredBlock]:
    """Stored signal of a part in blocks of records, of at most so many samples; chunks are inflated without the lock."""
    source, rows = _rows_of(path)
    first, last = (0, 1) if rows is None else (rows.start, rows.stop)
    while first < last:
        with _opened(source) as file:
            stored = own_dataset(file.handle, SIGNAL)
            records, channels, samples = checked_shape(stored)
            last = records if rows is None else rows.stop
            block = range(first, min(first + max(1, most_samples // max(1, channels * samples)), last))
            deflated = is_deflated(stored)
            read: Any = _chunks(stored, block, range(channels)) if deflated else stored[block.start : block.stop]
        if deflated:
            values = np.empty((len(block), channels, samples), np.int16)
            for counts, out in zip(_all_inflated(read, samples, source.path), values.reshape(-1, samples), strict=True):
                out[:] = counts
            yield StoredBlock(values, [chunk for _, chunk in read])
        else:
            yield StoredBlock(read, None)
        first = block.stop
    if rows is None:
        _close([source])  # an open file holds 1 MB


def _rows_of(part: Path) -> tuple[Source, range | None]:
    """File that holds a part, and the numbers of its records there if that is a packed file."""
    if home_of(part) is None:
        return source_of(part), None
    home, place = packed_part(part)
    return source_of(home), range(place.first, place.first + place.records)


def _numbers(stored: h5py.Dataset, name: str, records: int, rows: range) -> NDArray[Any]:
    if not is_text(stored, name, "record", records):
        return np.asarray(stored[rows.start : rows.stop])
    raise ValueError(f"{name} is text, not numbers")


def _variables(file: _OpenFile, source: Source, sizes: dict[str, int]) -> dict[str, xr.Variable]:
    """All variables of a file except the signal."""
    found: dict[str, xr.Variable] = {}
    others = (SIGNAL, FILES, RECORD_HASH) if PACKED in file.handle.attrs else (SIGNAL,)
    for name in map(str, file.handle):
        if name not in others:
            stored = own_dataset(file.handle, name)
            if not is_bare_dimension(stored):
                found[name] = _variable(source, stored, name, sizes)
                file.checked[name] = stored
    return found


def _variable(source: Source, stored: h5py.Dataset, name: str, sizes: dict[str, int]) -> xr.Variable:
    """Variable of one value per record, or an axis of the signal."""
    dimension = name if name in SIGNAL_DIMS else "record"
    text = is_text(stored, name, dimension, sizes[dimension])
    attributes = plain_attributes(stored, name)
    array = indexing.LazilyIndexedArray(_Column(source, name, stored.shape, stored.dtype))
    return xr.Variable((dimension, f"{name}_length") if text else (dimension,), array, attributes)
