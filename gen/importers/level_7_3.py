"""One variable of a MATLAB file of level 7.3, which is an HDF5 file; damaged files are refused with a reason.

The HDF5 library decompresses a chunk into as much memory as the file asks for, returns fill values for values that were never written, and
follows links to other files. So sizes and storage are checked first, and compressed chunks are decompressed here.
"""

import math
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.hdf5 import LIBRARY_LOCK, ForeignStorageError, own_dataset
from gen.importers.files import UnusableError
from gen.importers.level_5 import listing
from gen.importers.unfolding import check_size, unfold

_DEFLATE, _SHUFFLE, _FLETCHER_32 = 1, 2, 3  # numbers of the filters in HDF5
_CHECKSUM = 4  # bytes
_MOST_CHUNKS = 100_000
_MOST_NAMES = 1000


def read_level_7_3(path: Path, variable: str) -> NDArray[Any]:
    """Numbers of a dataset; ``"bearing.gs"`` is a dataset in a group.

    Raises
    ------
    UnusableError
        If the file does not hold the dataset itself, or its size does not match its storage.
    """
    with LIBRARY_LOCK, h5py.File(path, "r") as file:
        try:
            dataset = own_dataset(file, variable.replace(".", "/"))
        except ForeignStorageError as error:
            message = f"refers to values outside the file: {error}"
            raise UnusableError(message) from None
        except KeyError:
            message = f"holds {listing([*islice(file, 6)])}, not {variable}"
            raise UnusableError(message) from None
        if dataset.dtype.kind not in "biuf" or dataset.shape is None:
            message = f"holds {variable}, but it is not real numbers"
            raise UnusableError(message)
        stored = min(dataset.id.get_storage_size(), path.stat().st_size)
        if stored == 0 and dataset.size:
            message = f"holds {variable}, but its values were never written"
            raise UnusableError(message)
        check_size(dataset.size * dataset.dtype.itemsize, stored)
        if dataset.chunks is None:
            return np.asarray(dataset)
        return _from_chunks(dataset, stored, path.stat().st_size)


def names_level_7_3(path: Path) -> list[tuple[str, int]]:
    """Names of the datasets of real numbers in the file and in its groups, as ``"bearing.gs"``, with their numbers of values."""
    found: list[tuple[str, int]] = []
    with LIBRARY_LOCK, h5py.File(path, "r") as file:
        for name in _paths(file):
            try:
                dataset = own_dataset(file, name)
            except (KeyError, ForeignStorageError):
                continue
            if dataset.dtype.kind in "iuf":
                found.append((name.replace("/", "."), int(dataset.size or 0)))
    return found


def _paths(file: h5py.File) -> Iterator[str]:
    """Paths of the members of the file and of its groups; ``#refs#`` holds the contents of cells."""
    for name in islice(file, _MOST_NAMES):
        yield name
        linked: Any = file.get(name, getclass=True, getlink=True)
        group: Any = file[name] if linked is h5py.HardLink and name != "#refs#" else None
        if isinstance(group, h5py.Group):
            yield from (f"{name}/{inner}" for inner in islice(group, _MOST_NAMES))


def _from_chunks(dataset: h5py.Dataset, stored: int, file_size: int) -> NDArray[Any]:
    """Values of a dataset stored in chunks; none may be missing or larger than a chunk when decompressed."""
    layout: Any = dataset.id.get_create_plist()
    filters = [layout.get_filter(number)[0] for number in range(layout.get_nfilters())]
    if filters not in ([], [_DEFLATE], [_SHUFFLE, _DEFLATE], [_SHUFFLE], [_FLETCHER_32], [_SHUFFLE, _FLETCHER_32],
                       [_DEFLATE, _FLETCHER_32], [_SHUFFLE, _DEFLATE, _FLETCHER_32]):  # fmt: skip
        message = f"uses the HDF5 filters {filters}; only deflate and shuffle are read"
        raise UnusableError(message)
    shape: tuple[int, ...] = dataset.shape or ()
    chunk: tuple[int, ...] = dataset.chunks or ()
    check_size(math.prod(chunk) * dataset.dtype.itemsize, stored)
    counts = [-(-side // length) for side, length in zip(shape, chunk, strict=True)]
    count = math.prod(counts)
    if count > _MOST_CHUNKS:
        message = f"is stored in {count} chunks; at most {_MOST_CHUNKS} are read"
        raise UnusableError(message)
    values = np.empty(shape, dataset.dtype)
    for number in range(count):
        steps = np.unravel_index(number, counts)
        first = tuple(int(step) * length for step, length in zip(steps, chunk, strict=True))
        found: Any = dataset.id.get_chunk_info_by_coord(first)
        if found.byte_offset is None or found.size > file_size:
            raise UnusableError("is damaged: parts of its values were never written")
        mask, packed = dataset.id.read_direct_chunk(first)
        used = [name for place, name in enumerate(filters) if not mask >> place & 1]
        block = _unpacked(packed, used, chunk, dataset.dtype)
        inside = tuple(slice(0, side - start) for side, start in zip(shape, first, strict=True))
        values[tuple(slice(start, start + length) for start, length in zip(first, chunk, strict=True))] = block[inside]
    return values


def _unpacked(packed: bytes, filters: list[int], shape: tuple[int, ...], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Values of a chunk; filters are reversed from the last to the first, and checksums are not compared."""
    content: Any = memoryview(packed)
    size = math.prod(shape) * dtype.itemsize
    for name in reversed(filters):
        if name == _FLETCHER_32:
            content = content[:-_CHECKSUM]
        elif name == _DEFLATE:
            content = unfold(content, size)
        else:
            content = np.frombuffer(content, np.uint8).reshape(dtype.itemsize, -1).T.ravel()
    return np.frombuffer(content, dtype).reshape(shape)
