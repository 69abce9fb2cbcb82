"""Stored records of a file, some at a time, read without xarray: for features, checks and copies."""

import math
import zlib
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.fault_classes import own_codes
from gen.corpus.layout import attributes_of, is_bare_dimension, is_text, plain_attributes
from gen.corpus.open_files import close, open_source, source_of
from gen.corpus.part import inflate
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS, class_names, operating_problems, stored_unit
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

if TYPE_CHECKING:
    import xarray as xr

_BLOCK_SAMPLES = 10_000_000
_BLOCK_RECORDS = 256


class RecordBlock(NamedTuple):
    """Consecutive records of a file, or of a Dataset in memory."""

    file: "Path | xr.Dataset"
    first: int
    stop: int


def blocks_of(path: Path, records: int) -> list[RecordBlock]:
    """All records of a file in blocks that fit the memory of a task."""
    starts = range(0, records, _BLOCK_RECORDS)
    return [RecordBlock(path, first, min(first + _BLOCK_RECORDS, records)) for first in starts]


def blocks_in_memory(records: "xr.Dataset") -> list[RecordBlock]:
    """Records in memory in blocks, each of which goes to its task alone."""
    count = records.sizes["record"]
    cuts = [slice(first, min(first + _BLOCK_RECORDS, count)) for first in range(0, count, _BLOCK_RECORDS)]
    return [RecordBlock(records.isel(record=cut), 0, cut.stop - cut.start) for cut in cuts]


def read_channel(
    block: RecordBlock, channel: int, names: Sequence[str]
) -> tuple[NDArray[np.float32], list[NDArray[Any]]]:
    """Signal of one channel of a block in single precision, shape (record, elapsed_time) [m s-2], and columns by name.

    Features use it: it reads the columns without xarray. Chunks are inflated without the lock, so that threads run in parallel.
    """
    if not isinstance(block.file, Path):
        signal = block.file[SIGNAL].values[:, channel].astype(np.float32, copy=False)
        return signal, [block.file[name].values for name in names]
    source, rows = source_of(block.file), range(block.first, block.stop)
    with open_source(source) as file:
        stored, (records, _, samples), packing, deflated = file.signal()
        read: Any = (
            stored_chunks(stored, rows, range(channel, channel + 1))
            if deflated
            else stored[rows.start : rows.stop, channel]
        )
        columns = [_numbers(file.dataset(name), name, records, rows) for name in names]
        for problem in operating_problems(dict(zip(names, columns, strict=True))):
            raise ValueError(problem.removesuffix("."))
    if block.stop == records:
        close([source])  # features read each file once, and an open file holds 1 MB
    if packing.scale is None:
        return read, columns
    signal = np.empty((len(rows), samples), np.float32)
    for row, counts in zip(signal, inflate_all(read, samples, source.path) if deflated else read, strict=True):
        packing.decode(counts, row)
    return signal, columns


def stored_blocks(path: Path) -> Iterator[NDArray[Any]]:
    """Stored signal of a file in blocks of records: counts of the converter, or accelerations [m s-2]; inflated without the lock."""
    source, first, records = source_of(path), 0, 1
    while first < records:
        with open_source(source) as file:
            stored, (records, channels, samples), _, deflated = file.signal()
            block = range(first, min(first + max(1, _BLOCK_SAMPLES // max(1, channels * samples)), records))
            read: Any = stored_chunks(stored, block, range(channels)) if deflated else stored[block.start : block.stop]
        if deflated:
            values = np.empty((len(block), channels, samples), np.int16)
            for counts, out in zip(inflate_all(read, samples, source.path), values.reshape(-1, samples), strict=True):
                out[:] = counts
            yield values
        else:
            yield read
        first = block.stop
    close([source])  # an open file holds 1 MB


def read_columns(
    path: Path, count: int, names: Iterable[str], where_present: Iterable[str] = ()
) -> dict[str, NDArray[Any]]:
    """Numbers of a file with ``count`` records, by the name of their variable: all of ``names``, and others that the file has."""
    source = source_of(path)
    with open_source(source) as file:
        wanted = [*names, *({*where_present} & {*map(bytes.decode, file.handle.id)})]
        columns = {name: _numbers(file.dataset(name), name, count, range(count)) for name in wanted}
        if "fault" in columns:
            classes = class_names(plain_attributes(file.dataset("fault"), "fault"))
            columns["fault"] = own_codes(columns["fault"], classes, path, attributes_of(file.handle))
    close([source])
    return columns


def read_units(path: Path, role: str) -> dict[str, str]:
    """Stored unit of each variable of a file that has a role and is in floating point, by name."""
    source, units = source_of(path), dict[str, str]()
    with open_source(source) as file:
        for name in map(bytes.decode, file.handle.id):
            stored = file.dataset(name)
            # the role first: all attributes of all variables take twice as long
            if stored.dtype.kind == "f" and np.asarray(stored.attrs.get("role", "")).astype(str) == role:
                units[name] = stored_unit(plain_attributes(stored, name))
    close([source])
    return units


def read_classes(path: Path) -> dict[int, str]:
    """Names of the fault classes by their codes in a file, which may not be those of this process."""
    with open_source(source_of(path)) as file:
        return class_names(plain_attributes(file.dataset("fault"), "fault"))


def read_texts(path: Path, name: str, count: int) -> list[str]:
    """Values of a variable of a file that is text, one for each of ``count`` records or channels."""
    source = source_of(path)
    with open_source(source) as file:
        stored = file.dataset(name)
        if not is_text(stored, name, "record", count):
            raise ValueError(f"{name} is numbers, not text")
        texts = [text.decode() for text in _rows(stored, 0, None).view(f"S{stored.shape[1]}")[:, 0].tolist()]
    close([source])
    return texts


def stored_columns(path: Path, first: int = 0, stop: int | None = None) -> dict[str, NDArray[Any]]:
    """Values of all per-record variables of a file by name, of all its records or of some.

    They are as they are stored, text as rows of characters, and are read without xarray.
    """
    source, columns = source_of(path), dict[str, NDArray[Any]]()
    with open_source(source) as file:
        for name in map(bytes.decode, file.handle.id):
            # the dimension of a text, NAME_length, has no values
            bare = name.endswith("_length") and is_bare_dimension(file.dataset(name))
            if not bare and name not in (SIGNAL, *SIGNAL_DIMS):
                columns[name] = _rows(file.dataset(name), first, stop)
    if stop is None:
        close([source])
    return columns


def _rows(stored: h5py.Dataset, first: int, stop: int | None) -> NDArray[Any]:
    """Values of some records of a variable; through the objects of h5py it takes twice as long."""
    records, *width = stored.id.shape
    shape = (len(range(records)[first:stop]), *width)
    size = math.prod(shape) * stored.id.dtype.itemsize
    check_limit("file_bytes", size, f"{stored.file.filename}: {stored.name} has", CorpusError)
    values, chosen = np.empty(shape, stored.id.dtype), stored.id.get_space()
    chosen.select_hyperslab((first, *(0 for _ in width)), shape)
    stored.id.read(h5py.h5s.create_simple(shape), chosen, values)
    return values


def _numbers(stored: h5py.Dataset, name: str, records: int, rows: range) -> NDArray[Any]:
    if not is_text(stored, name, "record", records):
        return np.asarray(stored[rows.start : rows.stop])
    raise ValueError(f"{name} is text, not numbers")


def stored_chunks(stored: h5py.Dataset, records: range, channels: range) -> list[tuple[int, bytes]]:
    """Stored chunks of some records and channels, each with the mask of the filters that were left out."""
    return [stored.id.read_direct_chunk((record, channel, 0)) for record in records for channel in channels]


def inflate_all(chunks: Sequence[tuple[int, bytes]], samples: int, path: str) -> Iterator[NDArray[np.int16]]:
    """Counts of each chunk; CorpusError if one is damaged."""
    for filters_left_out, chunk in chunks:
        try:
            yield inflate(b"" if filters_left_out else chunk, samples)
        except (ValueError, zlib.error) as error:
            raise CorpusError(f"{path}: damaged ({error}); generate or copy it again.") from None
