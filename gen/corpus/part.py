"""One file of records: a complete netCDF-4 file, written atomically, that ends with its checksum. The parts of a corpus are such files."""

import json
import re
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import h5py
import netCDF4
import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from gen.corpus.codecs import CODECS, Codec
from gen.corpus.files import append_checksum, whole_or_not_at_all
from gen.corpus.hdf5 import LIBRARY_LOCK
from gen.corpus.schema import SIGNAL
from gen.corpus.signals import Count, SignalCounts, count_verdicts, judge
from gen.corpus.unicode_text import set_attributes, write_unicode

if TYPE_CHECKING:
    import xarray as xr

_INCOMPRESSIBLE = 7.8  # bits per byte
_NAME = re.compile(r"part-([0-9]{5,9})(-[0-9]{1,6})?\.nc")


class PartRow(NamedTuple):
    """Entry of a part in the manifest."""

    name: Annotated[str, Field(pattern=f"^{_NAME.pattern}$")]
    records: Count
    bytes: Count
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
    signals: SignalCounts = SignalCounts()
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


Chunks = Mapping[tuple[int, ...], bytes]


def write_part(dataset: "xr.Dataset", path: Path, codec: Codec = "zlib") -> PartRow:
    """Write records as a part, atomically, with one chunk per record and channel; the attribute ``signals`` counts unusable records.

    ``zlib`` can be read everywhere; plain h5py and stock ncdump need a plugin to read ``zstd``.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    signal = dataset[SIGNAL].values
    signals = count_verdicts(judge(signal))
    chunks = {at: deflate(signal[at]) for at in np.ndindex(signal.shape[:2])} if codec == "zlib" else {}
    with whole_or_not_at_all(path) as temporary, LIBRARY_LOCK:
        with netCDF4.Dataset(temporary, "w", format="NETCDF4") as file:
            attributes = {name: dataset.attrs[name] for name in sorted(map(str, dataset.attrs))}
            texts = set_attributes(file, attributes | {"signals": json.dumps(signals._asdict())})
            for dimension, size in dataset.sizes.items():
                file.createDimension(str(dimension), size)
            # all variables are declared before any is written: alternating takes 50 % longer
            labels = " ".join(sorted(str(label) for label in set(dataset.coords) - set(dataset.dims)))
            declared = [_declare(file, str(name), dataset, codec, labels) for name in dataset.variables]
            for stored, values in declared:
                if stored.name != SIGNAL or not chunks:
                    stored[:] = values
        if chunks or texts:
            with h5py.File(temporary, "r+") as file:
                write_unicode(file, texts)
                _write_chunks(chunks, file)
        digest = append_checksum(temporary)
    return PartRow(path.name, len(signal), path.stat().st_size, digest, signals)


def _declare(
    file: netCDF4.Dataset, name: str, dataset: "xr.Dataset", codec: Codec, labels: str
) -> tuple[netCDF4.Variable, NDArray[Any]]:
    """Declare a variable, and return it with its values; ``labels`` are the text variables that belong to all others.

    Text is stored as fixed-length characters: HDF5 2.2 can crash on variable-length strings after another file was closed.
    """
    variable = dataset.variables[name]
    values, dimensions, attributes = variable.values, tuple(map(str, variable.dims)), dict(variable.attrs)
    storage: dict[str, Any] = {"fill_value": attributes.pop("_FillValue", False)}
    if name == SIGNAL:
        storage |= {"chunksizes": (1, 1, values.shape[2]), **CODECS[codec].options}
        if values.dtype.kind == "f":
            storage["fill_value"] = np.nan
    elif name == "elapsed_time":
        storage |= CODECS["zlib"].options
    elif values.dtype.kind in "OU":
        values = np.array([text.encode() for text in values], "S")
        values = values.view("S1").reshape(len(values), -1)
        dimensions += (f"{name}_length",)
        file.createDimension(dimensions[-1], values.shape[1])
        storage |= {"zlib": True, "complevel": 1}
        attributes["_Encoding"] = "utf-8"
    if name in dataset.data_vars:
        attributes["coordinates"] = labels
    stored = file.createVariable(name, values.dtype, dimensions, **storage)
    stored.set_auto_maskandscale(False)
    stored.set_auto_chartostring(False)
    stored.setncatts(attributes)
    return stored, values


def _write_chunks(chunks: Chunks, file: h5py.File) -> None:
    """Write compressed chunks of the signal directly: the zlib filter of HDF5 takes more than twice as long."""
    stored: Any = file[SIGNAL]
    for (record, channel), chunk in chunks.items():
        stored.id.write_direct_chunk((record, channel, 0), chunk)


def deflate(samples: NDArray[Any]) -> bytes:
    r"""Samples after the shuffle of HDF5 as a zlib stream, of about the size of level 1.

    The lower bytes of a noisy signal cannot be compressed: planes with evenly distributed bytes are stored as they are. The other planes
    are run-length coded, because only runs repeat in them.

    >>> zlib.decompress(deflate(np.array([1, 2, 3], np.int16)))
    b'\x01\x02\x03\x00\x00\x00'
    """
    planes = np.ascontiguousarray(samples.view(np.uint8).reshape(len(samples), -1).T)
    pieces = [b"\x78\x01"]
    for plane in planes:
        level = 0 if _entropy(plane[:: 1 + len(plane) // 4096]) > _INCOMPRESSIBLE else 1
        coder = zlib.compressobj(level, zlib.DEFLATED, -zlib.MAX_WBITS, strategy=zlib.Z_RLE)
        pieces += coder.compress(plane), coder.flush(zlib.Z_FULL_FLUSH)
    return b"".join([*pieces, b"\x03\x00", zlib.adler32(planes.data).to_bytes(4, "big")])


def inflate(chunk: bytes, samples: int) -> NDArray[np.int16]:
    """Counts from a zlib stream of their shuffled bytes, as from :func:`deflate`; ValueError if their number is not ``samples``.

    >>> inflate(deflate(np.array([1, -2, 300], np.int16)), 3)
    array([  1,  -2, 300], dtype=int16)
    """
    stream = zlib.decompressobj()
    planes = stream.decompress(chunk, 2 * samples + 1)
    if len(planes) != 2 * samples or not stream.eof:
        raise ValueError(f"a chunk does not hold {samples} samples")
    low, high = np.frombuffer(planes, np.uint8).reshape(2, samples)
    counts = high.view(np.int8).astype(np.int16)
    counts <<= 8
    counts |= low
    return counts


def _entropy(values: NDArray[np.uint8]) -> float:
    """Entropy of bytes [bit per byte]."""
    counts = np.bincount(values)
    shares = counts[counts > 0] / len(values)
    return -float(shares @ np.log2(shares))
