"""One variable of a MATLAB file, level 5 [1]_ or 7.3 (HDF5), whatever state the file is in.

A level 5 file is a header and a row of elements, each a type, a length and its bytes; an array is an
element of elements. They are read here and not by ``scipy.io.loadmat``, which trusts the types it finds: of
1,000 bytes altered one at a time in the tags of a first array, 29 ended the process (scipy 1.17). Here
every type and length is checked before it is used.

.. [1] The MathWorks, *MAT-File Format*, chapter 1.
"""

import math
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.importers.files import UnusableError, guarded

_HEADER = 128
_BYTE_ORDERS = {b"IM": "<", b"MI": ">"}
_HDF5_MAGIC = b"\x89HDF\r\n\x1a\n"
_HDF5_OFFSET = 512  # level 7.3 puts a header of its own before the HDF5 file
_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_TEXTS = {
    "<": {1: "latin-1", 2: "latin-1", 4: "utf-16-le", 16: "utf-8", 17: "utf-16-le", 18: "utf-32-le"},
    ">": {1: "latin-1", 2: "latin-1", 4: "utf-16-be", 16: "utf-8", 17: "utf-16-be", 18: "utf-32-be"},
}
_STRUCTURE, _TEXT, _NUMERIC = 2, 4, range(6, 16)
_COMPLEX_FLAG = 0x0800


class _Array(NamedTuple):
    """An array as stored: its class, name and shape, and the elements that hold its values."""

    kind: int
    is_complex: bool
    shape: tuple[int, ...]
    name: str
    parts: list[tuple[int, memoryview]]


def read_matlab(path: Path, variable: str) -> NDArray[Any]:
    """Numbers, or text as an array of one string; ``"bearing.gs"`` is a field of a structure.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, is no MATLAB file, or does not hold such a variable.
    """
    with path.open("rb") as stream:
        head = stream.read(_HDF5_OFFSET + len(_HDF5_MAGIC))
    if _HDF5_MAGIC in (head[: len(_HDF5_MAGIC)], head[_HDF5_OFFSET:]):
        return guarded("MATLAB 7.3", lambda: _read_hdf5(path, variable))
    if head[126:128] not in _BYTE_ORDERS:
        raise UnusableError("is no MATLAB file of level 5 or 7.3")
    return guarded("MATLAB", lambda: _read_level_5(path, variable))


def _read_hdf5(path: Path, variable: str) -> NDArray[Any]:
    with h5py.File(path) as file:
        value = file.get(variable.replace(".", "/"))
        if not isinstance(value, h5py.Dataset):
            message = f"holds {_listing(list(file))}, not {variable}"
            raise UnusableError(message)
        return np.asarray(value)


def _read_level_5(path: Path, variable: str) -> NDArray[Any]:
    content = memoryview(path.read_bytes())
    order = _BYTE_ORDERS[bytes(content[126:_HEADER])]
    wanted, *fields = variable.split(".")
    names: list[str] = []
    # a list, so that a file which ends too early is found out before the variable is
    for kind, data in list(_elements(content[_HEADER:], order)):
        array = _array(kind, data, order)
        if array.name == wanted:
            return _values(_field(array, fields, order), variable, order)
        names.append(array.name)
    message = f"holds {_listing(names)}, not {wanted}"
    raise UnusableError(message)


def _elements(data: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Type and bytes of each element; up to four bytes stand in the place of the length, not after it."""
    position = 0
    while position < len(data):
        kind, length = np.frombuffer(data[position : position + 8], order + "u4", 2).tolist()
        start, room = position + 8, len(data) - position - 8
        if kind >> 16:
            kind, length, start, room = kind & 0xFFFF, kind >> 16, position + 4, 4
        if length > room:
            message = f"is truncated or damaged: {length} bytes announced where {room} are left"
            raise UnusableError(message)
        yield kind, data[start : start + length]
        position = start + length
        if kind != _COMPRESSED:
            position += -position % 8


def _array(kind: int, data: memoryview, order: str) -> _Array:
    if kind == _COMPRESSED:
        kind, data = next(_elements(memoryview(zlib.decompress(data)), order))
    if kind != _MATRIX:
        message = f"is damaged: an element of type {kind} where an array should be"
        raise UnusableError(message)
    (_, flags), (_, shape), (_, name), *parts = _elements(data, order)
    (flag, *_) = np.frombuffer(flags, order + "u4").tolist()
    sides = tuple(np.frombuffer(shape, order + "i4").tolist())
    return _Array(flag & 0xFF, bool(flag & _COMPLEX_FLAG), sides, bytes(name).decode("latin-1"), parts)


def _field(array: _Array, fields: list[str], order: str) -> _Array:
    """Follow field names into structures of one element."""
    for field in fields:
        if array.kind != _STRUCTURE or math.prod(array.shape) != 1:
            message = f"holds {array.name or 'a field'}, but not as one structure with a {field}"
            raise UnusableError(message)
        (_, width), (_, text), *values = array.parts
        (size,) = np.frombuffer(width, order + "i4").tolist()
        names = [bytes(text[at : at + size]).rstrip(b"\0").decode("latin-1") for at in range(0, len(text), size)]
        if field not in names:
            message = f"holds a structure of {_listing(names)}, not {field}"
            raise UnusableError(message)
        array = _array(*values[names.index(field)], order)
    return array


def _values(array: _Array, variable: str, order: str) -> NDArray[Any]:
    if array.kind not in (_TEXT, *_NUMERIC) or array.is_complex:
        message = f"holds {variable}, but neither as real numbers nor as text"
        raise UnusableError(message)
    kind, data = array.parts[0]
    known = _TEXTS[order] if array.kind == _TEXT else _NUMBERS
    if kind not in known:
        message = f"is damaged: values of unknown type {kind} in {variable}"
        raise UnusableError(message)
    if array.kind == _TEXT:
        return np.array(bytes(data).decode(known[kind]))
    return np.frombuffer(data, order + known[kind]).reshape(array.shape, order="F")


def _listing(names: list[str]) -> str:
    shown = ", ".join(names[:6]) or "nothing"
    return f"{shown} and {len(names) - 6} more" if len(names) > 6 else shown
