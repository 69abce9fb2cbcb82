"""Members of a model file: a zip archive of arrays (``.npy``) and one member of JSON, none of them compressed.

Names and sizes are checked before a member is read, and the header of an array is compared with the size of its member before the array is
created. So reading a file takes at most a few times its size in memory.
"""

import io
import math
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from gen.errors import CorpusError
from gen.limits import check_limit

SCHEMA = "schema.json"
_ARRAY = re.compile(r"[0-9a-f-]{1,40}\.npy")
_MOMENT = (1980, 1, 1, 0, 0, 0)  # earliest date of the zip format, used for all members


def read_members(source: Path | IO[bytes], name: str) -> dict[str, bytes]:
    """Read all members after a check of their names and sizes; an error sentence begins with ``name``.

    Raises
    ------
    CorpusError
        If a member does not belong in a model file, or is larger than the limits.
    zipfile.BadZipFile
        If the zip is damaged; Python's reader raises other types too.
    """
    with zipfile.ZipFile(source) as archive:
        _check_members(archive.infolist(), name)
        return {entry.filename: archive.read(entry) for entry in archive.infolist()}


def write_members(members: Mapping[str, bytes]) -> bytes:
    """Zip archive of some members in their order; equal members give equal bytes."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for name, content in members.items():
            entry = zipfile.ZipInfo(name, _MOMENT)
            entry.create_system = 3  # Unix on every system, so that equal members give equal bytes
            archive.writestr(entry, content)
    return file.getvalue()


def _check_members(entries: list[zipfile.ZipInfo], name: str) -> None:
    check_limit("file_bytes", sum(entry.file_size for entry in entries), f"{name}: its members take", CorpusError)
    for entry in entries:
        if entry.filename != SCHEMA and not _ARRAY.fullmatch(entry.filename):
            refuse_member(name, f"{entry.filename[:60]!r} is no member of a model")
        if entry.compress_type != zipfile.ZIP_STORED or entry.compress_size != entry.file_size:
            refuse_member(name, f"{entry.filename} is compressed")
    sizes = {entry.filename: entry.file_size for entry in entries}
    if len(sizes) < len(entries):
        refuse_member(name, "two members have the same name")
    if SCHEMA not in sizes:
        refuse_member(name, f"{SCHEMA} is missing")
    check_limit("schema_bytes", sizes[SCHEMA], f"{name}: its {SCHEMA} takes", CorpusError)


def read_array(content: bytes) -> tuple[NDArray[Any], bytes]:
    """Array of a ``.npy`` file, checked against its size before anything is allocated."""
    file = io.BytesIO(content)
    match np.lib.format.read_magic(file):
        case (1, 0):
            shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
        case other:
            raise ValueError(f"an array of format {other}")
    if dtype.hasobject or any(length < 0 for length in shape):
        raise ValueError(f"an array of {dtype} and shape {shape}")
    start, size = file.tell(), math.prod(shape) * dtype.itemsize
    if len(content) - start != size:
        raise ValueError(f"an array of {size} bytes in a member of {len(content) - start}")
    values = np.frombuffer(content, np.uint8, offset=start).view(dtype) if size else np.empty(0, dtype)
    return values.reshape(shape, order="F" if fortran else "C"), content


def without_padding(array: NDArray[Any], content: bytes) -> tuple[NDArray[Any], bytes]:
    """The same array with zeros between the fields of a record, which NumPy leaves uninitialised."""
    if array.dtype.names is None:
        return array, content
    clean = np.zeros(array.shape, array.dtype)
    for name in array.dtype.names:
        clean[name] = array[name]
    file = io.BytesIO()
    np.lib.format.write_array(file, clean, (1, 0), allow_pickle=False)
    return clean, file.getvalue()


def refuse_member(name: str, reason: str) -> NoReturn:
    """Raise the error of a file that is damaged or not a model."""
    raise CorpusError(f"{name}: not a readable model ({reason}); train it again.")
