"""The index ``corpus.nc`` over the parts, and the opening of a corpus.

``corpus.nc`` holds all per-record variables and, for the signal, an HDF5 virtual dataset over the parts, so that any netCDF-4
reader sees one file. :func:`open_corpus` reads the variables from it, and the signal from the parts.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.files import whole_or_not_at_all
from gen.corpus.hdf5 import LIBRARY_LOCK
from gen.corpus.manifest import INDEX_NAME, Check, part_paths, read_manifest
from gen.corpus.packed import PACKED
from gen.corpus.part import PartRow
from gen.corpus.reading import open_records
from gen.corpus.schema import MISSING_COUNT, SIGNAL
from gen.corpus.unicode_text import set_attributes, write_unicode
from gen.errors import CorpusError

_COMMENT = (
    "This file alone holds no signals: they lie in parts/ beside it. To hand over one file, use raceway pack. "
    f"{SIGNAL} is an HDF5 virtual dataset over the files in parts/. HDF5 reads a part that it cannot open as missing values, without an "
    "error: a missing part, or one beyond the number of files a process may open. It also looks for parts/ in the folder that the "
    "environment variable HDF5_VDS_PREFIX names and in the current folder. Compare the files with manifest.json first (raceway validate)."
)
OF_ONE_FILE = ("comment", "_NCProperties", PACKED)
"""Global attributes about ``corpus.nc`` or a packed file itself."""
_NO_ATTRIBUTES: Mapping[str, str] = {}
_CHUNK_RECORDS = 256  # records whose text forms one chunk
_COPIED_BYTES = 16_000_000  # of the variables of some parts, in memory at a time


def open_corpus(directory: Path | str, check: Check = "sha256") -> xr.Dataset:
    """Open a corpus as one dataset, which is read lazily.

    Parameters
    ----------
    directory : path
        The folder that holds ``corpus.nc``, or a packed file (:func:`gen.pack`).
    check : {"sha256", "size"}
        Comparison of each file with the manifest before anything is read; of a packed file, of each record with its hash ("sha256") or of
        none.

    Returns
    -------
    Dataset
        ``acceleration (record, channel, elapsed_time)`` [m s-2] and the variables of :data:`gen.corpus.SCHEMA`. It can be pickled,
        and chunked for dask with ``.chunk({"record": n})``.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing, altered or outside its folder.
    """
    directory = Path(directory)
    paths = part_paths(directory, check)
    if directory.is_file():
        return open_records(directory, [directory])
    return open_records(directory / INDEX_NAME, paths, [row.records for row in read_manifest(directory).parts])


def write_index(directory: Path, rows: list[PartRow], attributes: Mapping[str, str] = _NO_ATTRIBUTES) -> None:
    """Write ``corpus.nc`` over the finished parts atomically; the same parts and attributes give the same bytes.

    ``attributes`` are global attributes beside those of the parts.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    with new_index(directory, rows, attributes):
        pass


@contextmanager
def new_index(directory: Path, rows: list[PartRow], attributes: Mapping[str, str]) -> Iterator[Path]:
    """Path of a written index that replaces ``corpus.nc`` at the end of the block."""
    with whole_or_not_at_all(directory / INDEX_NAME) as temporary:
        with LIBRARY_LOCK:
            texts = write_variables(directory, rows, temporary, {"comment": _COMMENT, **attributes})
            _write_virtual_signal(directory, rows, temporary)
            with h5py.File(temporary, "r+") as file:
                write_unicode(file, texts)
        yield temporary


def corpus_attributes(file: Path) -> dict[str, Any]:
    """Global attributes of ``corpus.nc`` or of a packed file that belong to the corpus, whichever of the two holds it."""
    try:
        with LIBRARY_LOCK, netCDF4.Dataset(file) as opened:
            return {name: opened.getncattr(name) for name in opened.ncattrs() if name not in OF_ONE_FILE}
    except (OSError, RuntimeError, AttributeError) as error:
        raise CorpusError(
            f"{file}: has no readable attributes ({error}); copy the file again, or pack again."
        ) from None


def write_variables(directory: Path, rows: list[PartRow], path: Path, attributes: Mapping[str, str]) -> dict[str, str]:
    """Copy all variables of the parts except the signal into a new file; ``attributes`` are global ones beside those of the parts.

    Returns the global attributes with letters beyond ASCII, which are still to be written (:mod:`gen.corpus.unicode_text`).

    The width of a text is that of the longest in any part. The parts are read one after the other with h5py, and copied
    ``_COPIED_BYTES`` at a time: opening one with netCDF4 takes 4 ms, and writing the variables of each part on their own as long again.
    """
    with (
        netCDF4.Dataset(directory / "parts" / rows[0].name) as first,
        netCDF4.Dataset(path, "w", format="NETCDF4") as index,
    ):
        first.set_auto_maskandscale(False)
        first.set_auto_chartostring(False)
        copied: dict[str, np.dtype[Any]] = {
            name: variable.dtype
            for name, variable in first.variables.items()
            if name != SIGNAL and variable.dimensions[0] == "record"
        }
        texts = [name for name, dtype in copied.items() if dtype == "S1"]
        lengths = {name: dimension.size for name, dimension in first.dimensions.items()}
        lengths |= _widths(directory, rows, texts) | {"record": sum(row.records for row in rows)}
        whole = {name: first.getncattr(name) for name in first.ncattrs() if name != "failures"}
        beyond_ascii = set_attributes(index, {**whole, **attributes})
        _declare_like(first, index, lengths)
        start = 0
        for block in _blocks(directory, rows, copied):
            for name, values in zip(copied, block, strict=True):
                index[name][(slice(start, start + len(values)), *map(slice, values.shape[1:]))] = values
            start += len(block[0])
    return beyond_ascii


def _widths(directory: Path, rows: list[PartRow], texts: list[str]) -> dict[str, int]:
    """Largest width of each text in the parts, by the name of its dimension."""
    widths = dict.fromkeys(texts, 0)
    for row in rows:
        with h5py.File(directory / "parts" / row.name, "r", locking=False) as part:
            for name in filter(part.__contains__, texts):
                widths[name] = max(widths[name], h5py.h5d.open(part.id, name.encode()).shape[1])
    return {f"{name}_length": width for name, width in widths.items()}


def _blocks(directory: Path, rows: list[PartRow], types: dict[str, np.dtype[Any]]) -> Iterator[list[NDArray[Any]]]:
    """Values of each variable over as many consecutive parts as fill ``_COPIED_BYTES``."""
    block: list[list[NDArray[Any]]] = []
    size = 0
    for row in rows:
        with h5py.File(directory / "parts" / row.name, "r", locking=False) as part:
            block.append([_values(part, name, dtype, row.records) for name, dtype in types.items()])
        size += sum(values.nbytes for values in block[-1])
        if size > _COPIED_BYTES:
            yield [_joined(values) for values in zip(*block, strict=True)]
            block, size = [], 0
    if block:
        yield [_joined(values) for values in zip(*block, strict=True)]


def _values(part: h5py.File, name: str, dtype: np.dtype[Any], records: int) -> NDArray[Any]:
    """Values of a per-record variable of a part, 0 if it has none; through the objects of h5py it takes twice as long."""
    if name not in part:
        return np.zeros((records, 0) if dtype == "S1" else records, dtype)
    stored = h5py.h5d.open(part.id, name.encode())
    values = np.empty(stored.shape, stored.dtype)
    stored.read(h5py.h5s.ALL, h5py.h5s.ALL, values)
    return values


def _joined(values: tuple[NDArray[Any], ...]) -> NDArray[Any]:
    """Values of consecutive parts one after the other; text is filled up to the width of the widest."""
    if values[0].ndim == 1:
        return np.concatenate(values)
    joined = np.zeros((sum(map(len, values)), max(value.shape[1] for value in values)), "S1")
    start = 0
    for value in values:
        joined[start : start + len(value), : value.shape[1]] = value
        start += len(value)
    return joined


def _declare_like(part: netCDF4.Dataset, index: netCDF4.Dataset, lengths: dict[str, int]) -> None:
    for name, length in lengths.items():
        index.createDimension(name, length)
    for name, variable in part.variables.items():
        if name == SIGNAL:
            continue
        storage: dict[str, Any] = {"fill_value": False}
        if variable.dtype == "S1" and variable.dimensions[0] == "record":  # drawn values repeat from record to record
            shape = [lengths[dimension] for dimension in variable.dimensions]
            storage |= {"zlib": True, "complevel": 1, "chunksizes": (min(_CHUNK_RECORDS, shape[0]), shape[1])}
        copy = index.createVariable(name, variable.dtype, variable.dimensions, **storage)
        copy.set_auto_maskandscale(False)
        copy.set_auto_chartostring(False)
        copy.setncatts({key: variable.getncattr(key) for key in variable.ncattrs()})
        if "record" not in variable.dimensions:
            copy[:] = variable[:]


def _write_virtual_signal(directory: Path, rows: list[PartRow], path: Path) -> None:
    with h5py.File(directory / "parts" / rows[0].name) as part:
        model: Any = part[SIGNAL]
        shape, dtype = model.shape, model.dtype
        attributes = {
            key: model.attrs[key] for key in model.attrs if key not in ("DIMENSION_LIST", "_Netcdf4Coordinates")
        }
    layout: Any = h5py.VirtualLayout((sum(row.records for row in rows), *shape[1:]), dtype)
    layout.dcpl.set_obj_track_times(False)
    first = 0
    for row in rows:
        source = h5py.VirtualSource(f"parts/{row.name}", SIGNAL, (row.records, *shape[1:]), dtype)
        layout[first : first + row.records] = source
        first += row.records
    with h5py.File(path, "r+") as index:
        fill = MISSING_COUNT if np.issubdtype(dtype, np.integer) else np.nan
        signal = index.create_virtual_dataset(SIGNAL, layout, fillvalue=fill)
        for key, value in attributes.items():
            signal.attrs[key] = value
        for axis, name in enumerate(("record", "channel", "elapsed_time")):
            signal.dims[axis].attach_scale(index[name])
