"""The one look at a file from a stranger before anything else reads it, and the lock of the HDF5 and netCDF libraries.

A netCDF-4 file is an HDF5 file, which can refer to other files for its values (external links, external storage, virtual datasets),
declare terabytes in a few bytes, and name attributes on which readers act. :func:`open_trusted` refuses a file with a variable that the
format does not have, and :func:`read_values` refuses values that do not have the declared size: HDF5 2.2 reads memory beyond a chunk that
is too short, and can crash.

Both libraries keep state for the whole process and are not thread-safe, so every call to them holds :data:`LIBRARY_LOCK`.
"""

import os
import threading
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

import h5py
import netCDF4  # noqa: F401 - tells HDF5 where its zstd filter is
import numpy as np
from numpy.typing import NDArray

from gen.corpus.codecs import Codec
from gen.corpus.disk import Stamp, stamp, system_reason
from gen.corpus.schema import MISSING_COUNT, SIGNAL, SIGNAL_DIMS
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

PACKING = ("scale_factor", "add_offset", "_FillValue")
"""Attributes by which readers decode a signal; only the signal may have them."""
ZSTD = 32015  # number of the filter, registered with The HDF Group
LIBRARY_LOCK = threading.RLock()
"""Held during every call to HDF5 or netCDF. ``fork`` waits for it, so a child process starts with the lock free."""

_HDF5: Any = h5py  # its low-level interface has no types
_DEFLATE, _SHUFFLE = 1, 2
_FILTERS = ((), (_DEFLATE,), (_SHUFFLE,), (_SHUFFLE, _DEFLATE), (ZSTD,), (_SHUFFLE, ZSTD))
_OF_SIGNALS = (np.dtype("i2"), np.dtype("f4"))
_ACTED_ON = {*PACKING, "missing_value", "_Unsigned", "dtype", "calendar", "bounds", "grid_mapping"}
_OF_HDF5 = {
    "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties", "_nc3_strict",
}  # fmt: skip
_trusted = set[tuple[str, Stamp]]()
"""Files that passed in this process, with their stamps: the look takes longer than opening a file."""

if hasattr(os, "register_at_fork"):  # Windows has no fork
    os.register_at_fork(
        before=LIBRARY_LOCK.acquire, after_in_parent=LIBRARY_LOCK.release, after_in_child=LIBRARY_LOCK.release
    )


class ForeignStorageError(ValueError):
    """A dataset with values outside the file that was opened."""


@contextmanager
def library_errors(path: Path | str) -> Iterator[None]:
    """Hold the lock of the libraries; all their errors become a CorpusError about ``path``."""
    with LIBRARY_LOCK:
        try:
            yield
        except CorpusError:
            raise
        except Exception as error:  # h5py raises a dozen unrelated types on damaged bytes
            reason = system_reason(error)
            if isinstance(error, KeyError):  # of a name, or of h5py with a sentence
                reason = str(error.args[0]) if " " in str(error.args[0]) else f"it has no variable {error.args[0]}"
            raise CorpusError(f"{path}: not a readable file of a corpus ({reason}); make or copy it again.") from error


def open_trusted(path: Path | str) -> h5py.File:
    """Open a file of records, or an index, after a look at all that it declares; the caller holds :func:`library_errors`.

    Raises
    ------
    ValueError
        If a variable is not one of the format. h5py raises other errors for damaged bytes.
    """
    key = str(Path(path).absolute()), stamp(path)
    file = h5py.File(path, "r", locking=False)
    try:
        if key not in _trusted:
            sizes = dict[str, int]()
            for name in map(str, file):
                name.encode()  # a name that is not UTF-8
                _check_variable(own_dataset(file, name), name, sizes)
            _trusted.add(key)
    except BaseException:
        file.close()
        raise
    return file


def file_facts(path: Path) -> tuple[dict[str, Any], int]:
    """Global attributes of a file of records, and the number of its records; CorpusError if it is none."""
    with library_errors(path), open_trusted(path) as file:
        return attributes_of(file), len(own_dataset(file, SIGNAL))


def codec_of(path: Path) -> Codec:
    """Codec of the signal of a file."""
    with library_errors(path), open_trusted(path) as file:
        filters = filters_of(own_dataset(file, SIGNAL))
    return "zstd" if ZSTD in filters else "zlib" if filters else "none"


def own_dataset(file: h5py.File, path: str) -> h5py.Dataset:
    """Dataset of an HDF5 file with its values in the same file; the caller holds the lock.

    ``path`` holds the names of the groups and of the dataset, separated by slashes.

    Raises
    ------
    KeyError
        If there is no such dataset.
    ForeignStorageError
        If a link on the path is not a hard link, or the values are in another file.
    """
    node: Any = file.id  # through the objects of h5py it takes three times as long
    for name in path.encode().split(b"/"):
        if not isinstance(node, _HDF5.h5g.GroupID) or not node.links.exists(name):
            raise KeyError(path)
        if node.links.get_info(name).type != _HDF5.h5l.TYPE_HARD:
            raise ForeignStorageError(f"{path} is a soft or external link")
        node = _HDF5.h5o.open(node, name)
    if not isinstance(node, _HDF5.h5d.DatasetID):
        raise KeyError(path)
    storage: Any = node.get_create_plist()
    if storage.get_external_count():
        raise ForeignStorageError(f"the values of {path} are in another file")
    if storage.get_layout() == _HDF5.h5d.VIRTUAL:
        raise ForeignStorageError(f"{path} is a virtual dataset")
    return h5py.Dataset(node)


def _check_variable(stored: h5py.Dataset, name: str, sizes: dict[str, int]) -> None:
    """ValueError unless a variable has an allowed type, shape, storage and attributes; ``sizes`` of dimensions are those so far."""
    attributes, signal = set(stored.attrs), name == SIGNAL
    if is_bare_dimension(stored):
        return
    shape, dtype, chunks = stored.shape, stored.dtype, stored.chunks
    text = dtype == np.dtype("S1")
    allowed = dtype in _OF_SIGNALS if signal else text or dtype.kind in "iuf"
    if shape is None or len(shape) != (3 if signal else 1 + text) or not allowed:
        raise ValueError(f"{name} is of type {dtype} and shape {shape}, not one value for each record")
    dimensions = SIGNAL_DIMS if signal else (name if name in SIGNAL_DIMS else "record",)
    for dimension, size in zip(dimensions, shape, strict=False):
        if sizes.setdefault(dimension, size) != size:
            raise ValueError(f"{name} has shape {shape}, not one value for each {dimension}")
    if chunks is not None and (
        filters_of(stored) not in _FILTERS or chunks[1:] != ((1, *shape[2:]) if signal else shape[1:])
    ):
        raise ValueError(f"{name} is stored in chunks or with filters that the format does not have")
    wrong = attributes & _ACTED_ON - (set(PACKING) if signal else set())
    if "_Encoding" in attributes and not (text and stored.attrs["_Encoding"] in ("utf-8", b"utf-8")):
        wrong = {"_Encoding"}
    if wrong:
        raise ValueError(f"{name} has the attribute {min(wrong)}, which it must not have")
    if signal:
        _check_signal(stored)


def _check_signal(stored: h5py.Dataset) -> None:
    """ValueError unless a signal has an allowed size, a chunk for each record and channel, and the packing of the format."""
    records, channels, samples = stored.shape
    check_limit("records", records, f"{stored.file.filename}: holds", CorpusError)
    check_limit("record_samples", channels * samples, f"{stored.file.filename}: a record has", CorpusError)
    # every record costs a chunk: a file with fewer chunks could claim any number of records
    if stored.chunks != (1, 1, samples) or stored.id.get_num_chunks() != records * channels:
        raise ValueError(f"{SIGNAL} is not stored as one chunk for each record and channel")
    scale, offset, fill = map(packing_of(stored).get, PACKING)
    if stored.dtype.kind == "f":
        right = scale is None and offset is None and (fill is None or np.isnan(fill))
    else:
        right = _is_scale(scale) and offset == 0 and getattr(fill, "dtype", None) == np.int16
    if not right:
        raise ValueError(f"{SIGNAL} has scale_factor {scale!r}, add_offset {offset!r}, _FillValue {fill!r}")


def packing_of(stored: h5py.Dataset) -> dict[str, Any]:
    """Attributes by which readers decode a signal."""
    return {name: plain(stored.attrs[name], name) for name in PACKING if name in stored.attrs}


def _is_scale(scale: Any) -> bool:
    """Whether a scale factor is a positive number with which every count is a normal number of its type."""
    if getattr(scale, "dtype", None) not in (np.float32, np.float64):
        return False
    limits = np.finfo(scale.dtype)
    return bool(limits.smallest_normal <= scale <= limits.max / -MISSING_COUNT)


def filters_of(stored: h5py.Dataset) -> tuple[int, ...]:
    """Numbers of the filters that chunks of a dataset pass when they are written, in their order."""
    storage: Any = stored.id.get_create_plist()
    return tuple(storage.get_filter(place)[0] for place in range(storage.get_nfilters()))


def is_bare_dimension(stored: h5py.Dataset) -> bool:
    """Whether a dataset only stores the size of a netCDF dimension."""
    if not stored.is_scale:  # asked first: reading an attribute takes ten times as long
        return False
    return bytes(stored.attrs.get("NAME", b"")).startswith(b"This is a netCDF dimension but not a netCDF variable")


def is_text(stored: h5py.Dataset) -> bool:
    """Whether a variable is text, with one character per column."""
    return stored.dtype == np.dtype("S1") and stored.ndim == 2


def attributes_of(node: h5py.Dataset | h5py.File) -> dict[str, Any]:
    """Attributes of a netCDF variable or file that are facts: texts and numbers; ValueError if one is neither."""
    names = [name for name in node.attrs if name not in _OF_HDF5 and name not in ("coordinates", "_Encoding")]
    return {name: plain(node.attrs[name], name) for name in names}


def plain(value: Any, name: str) -> Any:
    """Text, a number, or a row of numbers; ValueError for anything else."""
    if isinstance(value, h5py.Empty):
        return ""
    if isinstance(value, bytes):
        return value.decode()
    if isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in "iuf":
        return value[0] if value.shape == (1,) else value
    if isinstance(value, str | np.integer | np.floating):
        return value
    raise ValueError(f"the attribute {name} is neither text nor numbers")


def read_values(stored: h5py.Dataset, *region: slice) -> NDArray[Any]:
    """Values of a region, whose slices have a start and a stop, after a check of their size.

    Raises
    ------
    ValueError
        If there are more than the limit, or a chunk does not have the size of its values.
    """
    whole = (*region, *(slice(0, size) for size in stored.shape[len(region) :]))
    size, chunks = stored.dtype.itemsize, stored.chunks
    check_limit("file_bytes", size * prod(of.stop - of.start for of in whole), "a variable has", ValueError)
    if chunks is not None and (last := filters_of(stored)[-1:]) != (ZSTD,):
        expected = size * prod(chunks)
        grid = [range(of.start // chunk * chunk, of.stop, chunk) for of, chunk in zip(whole, chunks, strict=True)]
        for place in product(*grid):
            left_out, chunk = stored.id.read_direct_chunk(place)
            if left_out or (_inflated_size(chunk, expected) if last == (_DEFLATE,) else len(chunk)) != expected:
                raise ValueError("damaged: a chunk does not have the size of its values")
    return stored[whole]


def _inflated_size(chunk: bytes, most: int) -> int:
    """Number of bytes of a zlib stream, counted to one above ``most``; -1 if it is none, or is cut off."""
    stream = zlib.decompressobj()
    try:
        size = len(stream.decompress(chunk, most + 1))
    except zlib.error:
        return -1
    return size if stream.eof else -1
