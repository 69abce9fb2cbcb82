"""One file of records: a complete netCDF-4 file, written atomically, that ends with its checksum. The parts of a corpus are such files."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import h5py
import netCDF4
import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from gen.corpus.codecs import CODECS, Codec
from gen.corpus.disk import append_checksum, whole_or_not_at_all
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS
from gen.corpus.trust import LIBRARY_LOCK
from gen.corpus.unusable import Count, SignalCounts, count_verdicts, judge

if TYPE_CHECKING:
    import xarray as xr

_TEXT_RECORDS = 256  # records whose text forms one chunk
_NAME = re.compile(r"part-([0-9]{5,9})(-[0-9]{1,6})?\.nc")


class PartRow(NamedTuple):
    """Entry of a part in the manifest."""

    name: Annotated[str, Field(pattern=f"^{_NAME.pattern}$")]
    records: Count
    bytes: Count
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
    signals: SignalCounts
    """Counts of the records that cannot be used."""


def part_name(number: int, records: int | None = None) -> str:
    """File name of a part. One that is not full has its number of records in its name, so that a larger corpus does not write over it.

    >>> part_name(3), part_name(4, 40)
    ('part-00003.nc', 'part-00004-40.nc')
    """
    return f"part-{number:05d}.nc" if records is None else f"part-{number:05d}-{records}.nc"


def part_number(name: str) -> int | None:
    """Number of a part from its file name; None for another name.

    >>> part_number("part-00004-40.nc"), part_number("index.nc")
    (4, None)
    """
    match = _NAME.fullmatch(name)
    return None if match is None else int(match[1])


def write_part(dataset: "xr.Dataset", path: Path, codec: Codec = "zlib") -> PartRow:
    """Write records as a part, atomically, with one chunk per record and channel; the attribute ``signals`` counts unusable records.

    ``zlib`` can be read everywhere; plain h5py and stock ncdump need a plugin to read ``zstd``.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    signals = count_verdicts(judge(dataset[SIGNAL].values))
    facts = {name: dataset.attrs[name] for name in sorted(map(str, dataset.attrs))}
    with whole_or_not_at_all(path) as temporary:
        columns = {str(name): _encoded(variable) for name, variable in dataset.variables.items()}
        write_netcdf(columns, facts | {"signals": json.dumps(signals)}, temporary, codec)
        digest = append_checksum(temporary)
    return PartRow(path.name, dataset.sizes["record"], path.stat().st_size, digest, signals)


def write_netcdf(
    columns: Mapping[str, "xr.Variable"],
    attributes: Mapping[str, Any],
    path: Path,
    codec: Codec = "zlib",
    blocks: Sequence[slice] = (slice(None),),
) -> None:
    """Write variables as they are stored, some records at a time, and global attributes.

    Text is stored as fixed-length characters: HDF5 2.2 can crash on variable-length strings after another file was closed. So global
    attributes with letters beyond ASCII, which netCDF4 writes with variable length, are written by h5py.
    """
    beyond = {name: text for name, text in attributes.items() if isinstance(text, str) and not text.isascii()}
    labels = sorted(name for name, of in columns.items() if of.dtype.kind in "SU" and name not in SIGNAL_DIMS)
    with LIBRARY_LOCK, netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts({name: value for name, value in attributes.items() if name not in beyond})
        for dimension, size in {dim: size for of in columns.values() for dim, size in of.sizes.items()}.items():
            file.createDimension(str(dimension), size)
        # all variables are declared before any is written: alternating takes 50 % longer
        declared = {name: _declare(file, name, of, codec, labels) for name, of in columns.items()}
        for block in blocks:
            for name, stored in declared.items():
                if name not in SIGNAL_DIMS:
                    stored[block] = _characters(columns[name][block])
                elif block == blocks[0]:
                    stored[:] = _characters(columns[name])
    write_texts(path, beyond)


def _encoded(variable: "xr.Variable") -> "xr.Variable":
    """Variable with its texts in UTF-8, as wide as the longest of them."""
    if variable.dtype.kind not in "OUT":
        return variable
    return type(variable.to_base_variable())(variable.dims, np.char.encode(variable.values.astype(str)), variable.attrs)


def _characters(variable: "xr.Variable") -> NDArray[Any]:
    """Values of a variable; of text, one character per column."""
    values, width = variable.values, _width(variable.dtype)
    if width is None:
        return values
    encoded = values if values.dtype.kind == "S" else np.char.encode(values)
    return encoded.astype(f"S{width}").view("S1").reshape(len(values), width)


def _width(dtype: np.dtype[Any]) -> int | None:
    """Characters of a stored text; None for numbers. Text of a file is read with as many characters as it has bytes."""
    return {"S": dtype.itemsize, "U": dtype.itemsize // 4}.get(dtype.kind)


def write_texts(path: Path, attributes: Mapping[str, str]) -> None:
    """Write global attributes of a file in fixed-length UTF-8; those that it has are replaced."""
    if attributes:
        with LIBRARY_LOCK, h5py.File(path, "r+") as file:
            for name, text in attributes.items():
                file.attrs[name] = np.bytes_(text.encode())


def _declare(
    file: netCDF4.Dataset, name: str, variable: "xr.Variable", codec: Codec, labels: Sequence[str]
) -> netCDF4.Variable:
    """Declare a variable; ``labels`` are the text variables that belong to all numbers of the records."""
    dtype, dimensions, attributes = variable.dtype, tuple(map(str, variable.dims)), dict(variable.attrs)
    storage: dict[str, Any] = {"fill_value": attributes.pop("_FillValue", False)}
    if name == SIGNAL:
        storage |= {"chunksizes": (1, 1, variable.shape[2]), **CODECS[codec]}
        if dtype.kind == "f":
            storage["fill_value"] = np.nan
    elif name == "elapsed_time":
        storage |= CODECS["zlib"]
    elif (width := _width(dtype)) is not None:
        file.createDimension(f"{name}_length", width)
        dimensions += (f"{name}_length",)
        storage |= {"zlib": True, "complevel": 1, "chunksizes": (min(_TEXT_RECORDS, len(variable)), width)}
        dtype, attributes["_Encoding"] = np.dtype("S1"), "utf-8"
    if name not in (*labels, *SIGNAL_DIMS):
        attributes["coordinates"] = " ".join(labels)
    stored = file.createVariable(name, dtype, dimensions, **storage)
    stored.set_auto_maskandscale(False)
    stored.set_auto_chartostring(False)
    stored.setncatts(attributes)
    return stored
