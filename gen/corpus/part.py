"""One part of a corpus: a complete netCDF-4 file of some hundred records, there whole or not there at all.

A part is written to a temporary name, flushed to disk and renamed, so that a killed writer leaves no half file under a part's name.
"""

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Literal, NamedTuple

import xarray as xr

from gen.corpus.schema import SIGNAL
from gen.errors import CorpusError

Codec = Literal["zlib", "zstd", "none"]
_CODECS: dict[Codec, dict[str, Any]] = {
    "zlib": {"zlib": True, "complevel": 1, "shuffle": True},
    "zstd": {"compression": "zstd", "complevel": 1, "shuffle": True},
    "none": {},
}


class PartRow(NamedTuple):
    """What the manifest says of a part."""

    name: str
    records: int
    bytes: int
    sha256: str


def part_name(number: int) -> str:
    """File name of a part.

    >>> part_name(3)
    'part-00003.nc'
    """
    return f"part-{number:05d}.nc"


def describe_part(path: Path) -> PartRow:
    """Row of the manifest for a part on disk; ``records`` is read from the file.

    Raises
    ------
    CorpusError
        If the file is no netCDF-4 file.
    """
    with open_part(path) as dataset:
        records = dataset.sizes["record"]
    return PartRow(path.name, records, path.stat().st_size, sha256(path))


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def open_part(path: Path) -> xr.Dataset:
    """Records of one part, decoded to m s-2 and read when touched.

    Raises
    ------
    CorpusError
        If the file is missing or no netCDF-4 file.
    """
    try:
        return xr.open_dataset(path, engine="netcdf4", decode_times=False)
    except (OSError, ValueError, KeyError) as error:
        raise CorpusError(f"{path}: not a readable netCDF-4 part ({error}); generate or copy it again.") from error


def write_part(dataset: xr.Dataset, path: Path, codec: Codec = "zlib") -> PartRow:
    """Write records as a part, whole or not at all, one chunk per record and channel.

    ``zlib`` can be read everywhere; ``zstd`` writes several times faster, but plain h5py and stock ncdump cannot read it.

    Raises
    ------
    CorpusError
        If the disk refuses the file, with the reason it gives.
    """
    encoding = {str(name): _encoding(str(name), variable) for name, variable in dataset.variables.items()}
    encoding[SIGNAL] = {"chunksizes": (1, 1, dataset.sizes["elapsed_time"]), **_CODECS[codec]}
    with whole_or_not_at_all(path) as temporary:
        dataset.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=encoding)
    return PartRow(path.name, dataset.sizes["record"], path.stat().st_size, sha256(path))


def _encoding(name: str, variable: xr.Variable) -> dict[str, Any]:
    """Text as fixed-length characters: HDF5 2.2 can crash on variable-length strings once another file was closed."""
    if variable.dtype.kind in "OU":
        return {"dtype": "S1", "char_dim_name": f"{name}_length", "zlib": True, "complevel": 1}
    compressed = {"zlib": True, "complevel": 1, "shuffle": True} if name == "elapsed_time" else {}
    return {"_FillValue": None, **compressed}


@contextmanager
def whole_or_not_at_all(path: Path) -> Iterator[Path]:
    """Temporary path to write to; flushed to disk it takes the place of ``path`` in one step, or is removed if anything fails.

    Raises
    ------
    CorpusError
        If the disk refuses the file, with the reason it gives.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        yield temporary
        with temporary.open("rb+") as stream:
            os.fsync(stream.fileno())
        temporary.replace(path)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except (OSError, RuntimeError) as error:
        raise CorpusError(
            f"{path}: could not be written ({error}); free some space or choose another folder."
        ) from error
    finally:
        with suppress(OSError):
            temporary.unlink()


def write_durably(content: bytes, path: Path) -> None:
    """Write a file, whole or not at all; CorpusError if the disk refuses it."""
    with whole_or_not_at_all(path) as temporary:
        temporary.write_bytes(content)


def write_text_durably(text: str, path: Path) -> None:
    """Write a text file, whole or not at all; CorpusError if the disk refuses it."""
    write_durably(text.encode(), path)
