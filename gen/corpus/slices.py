"""Values of files of records by plain slices of h5py, without xarray: for features, checks, indexes and summaries."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.codecs import Codec
from gen.corpus.fault_classes import own_codes
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS, class_names, operating_problems
from gen.corpus.trust import (
    ZSTD,
    attributes_of,
    filters_of,
    is_bare_dimension,
    is_text,
    library_errors,
    open_trusted,
    own_dataset,
    packing_of,
    read_values,
)
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


def blocks_of(file: "Path | xr.Dataset", records: int) -> list[RecordBlock]:
    """All records of a file, or of a Dataset in memory, in blocks that fit the memory of a task."""
    cuts = [(first, min(first + _BLOCK_RECORDS, records)) for first in range(0, records, _BLOCK_RECORDS)]
    if isinstance(file, Path):
        return [RecordBlock(file, first, stop) for first, stop in cuts]
    return [RecordBlock(file.isel(record=slice(first, stop)), 0, stop - first) for first, stop in cuts]


@contextmanager
def opened(path: Path | str) -> Iterator[h5py.File]:
    """A file for one look, under the lock of the libraries; all their errors become a CorpusError."""
    with library_errors(path), open_trusted(path) as file:
        yield file


def variables_of(file: h5py.File) -> dict[str, h5py.Dataset]:
    """All variables of a file that passed except its signal, by name."""
    stored = {name: own_dataset(file, name) for name in map(str, file) if name != SIGNAL}
    return {name: variable for name, variable in stored.items() if not is_bare_dimension(variable)}


def _variable(file: h5py.File, name: str) -> h5py.Dataset:
    """One of :func:`variables_of`."""
    stored = own_dataset(file, name)
    if is_bare_dimension(stored):
        raise KeyError(name)
    return stored


def file_facts(path: Path) -> tuple[dict[str, Any], tuple[int, int, int]]:
    """Global attributes of a file of records, and the shape of its signal; CorpusError if it is none."""
    with opened(path) as file:
        return attributes_of(file), own_dataset(file, SIGNAL).shape


def read_attributes(path: Path) -> dict[str, dict[str, Any]]:
    """Attributes of each per-record variable of a file, by name."""
    with opened(path) as file:
        return {name: attributes_of(stored) for name, stored in variables_of(file).items() if name not in SIGNAL_DIMS}


def read_columns(
    path: Path, names: Iterable[str] | None = None, first: int = 0, stop: int | None = None
) -> dict[str, NDArray[Any]]:
    """Values of variables of a file by name, of all its records or of some; without ``names`` those of all per-record variables.

    Faults have the codes of this process.
    """
    with opened(path) as file:
        stored = variables_of(file)
        names = [name for name in stored if name not in SIGNAL_DIMS] if names is None else names
        columns = {
            name: column_values(stored[name], first, len(stored[name]) if stop is None else stop) for name in names
        }
        if "fault" in columns:
            classes = class_names(attributes_of(stored["fault"]))
            columns["fault"] = own_codes(columns["fault"], classes, path, attributes_of(file))
        return columns


def read_classes(path: Path) -> dict[int, str]:
    """Names of the fault classes by their codes in a file, which may not be those of this process."""
    return class_names(read_attributes(path)["fault"])


def column_type(stored: h5py.Dataset) -> np.dtype[Any]:
    """Type of the values of a variable; of text, the number of characters is that of the stored bytes."""
    if not is_text(stored):
        return stored.dtype.newbyteorder("=")
    check_limit("file_bytes", 4 * stored.shape[1], "a text has", ValueError)
    return np.dtype(f"U{max(1, stored.shape[1])}")


def column_values(stored: h5py.Dataset, first: int, stop: int) -> NDArray[Any]:
    """Values of some records of a variable, with the codes of the file: all reads of labels go through this function."""
    values = read_values(stored, slice(first, stop))
    if not is_text(stored):
        return values.astype(column_type(stored), copy=False)
    rows = (
        np.ascontiguousarray(values).view(f"S{values.shape[1]}")[:, 0] if values.size else np.zeros(len(values), "S1")
    )
    return np.char.decode(rows, "utf-8").astype(column_type(stored))


def codec_of(path: Path) -> Codec:
    """Codec of the signal of a file."""
    with opened(path) as file:
        filters = filters_of(own_dataset(file, SIGNAL))
    return "zstd" if ZSTD in filters else "zlib" if filters else "none"


def read_channel(
    block: RecordBlock, channel: int, names: Iterable[str]
) -> tuple[NDArray[np.float32], list[NDArray[Any]]]:
    """Signal of one channel of a block in single precision, shape (record, elapsed_time) [m s-2], and columns by name."""
    if not isinstance(block.file, Path):
        signal = block.file[SIGNAL].values[:, channel].astype(np.float32, copy=False)
        return signal, [block.file[name].values for name in names]
    with opened(block.file) as file:
        stored = own_dataset(file, SIGNAL)
        values = read_values(stored, slice(block.first, block.stop), slice(channel, channel + 1))[:, 0]
        packing = packing_of(stored)
        columns = {name: column_values(_variable(file, name), block.first, block.stop) for name in names}
        for problem in operating_problems(columns):
            raise ValueError(problem.removesuffix("."))
    if "scale_factor" not in packing:
        return values, [*columns.values()]
    signal = np.multiply(values, packing["scale_factor"], dtype=np.float32, casting="same_kind")
    signal[values == packing["_FillValue"]] = np.nan
    return signal, [*columns.values()]


def stored_blocks(path: Path) -> Iterator[NDArray[Any]]:
    """Stored signal of a file in blocks of records: counts of the converter, or accelerations [m s-2]."""
    first, (records, channels, samples) = 0, file_facts(path)[1]
    step = max(1, _BLOCK_SAMPLES // max(1, channels * samples))
    for first in range(0, records, step):
        with opened(path) as file:
            block = read_values(own_dataset(file, SIGNAL), slice(first, min(first + step, records)))
        yield block
