"""One variable of a MATLAB file of level 5 [1]_; damaged files are refused with a reason.

Such a file is a header and a sequence of elements, each with a type, a length and its bytes; an array is an element of elements.
``scipy.io.loadmat`` is not used, because it trusts the types in the file: of 1,000 single altered bytes in the tags of a first array, 29
ended the process (scipy 1.17). Here every type and length is checked before it is used.

.. [1] The MathWorks, *MAT-File Format*, chapter 1.
"""

import math
import os
from collections.abc import Iterator
from itertools import islice
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.importers.files import UnusableError
from gen.importers.unfolding import check_size, first_bytes, unfold
from gen.limits import check_limit

HEADER = 128
BYTE_ORDERS = {b"IM": "<", b"MI": ">"}
_HEAD = 4096  # bytes that hold the name of a variable
_MOST = 10_000  # variables of a file, fields of a structure
_LONGEST_FIELD, _LONGEST_TEXT = 4096, 1_000_000  # bytes
_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_TEXTS = {
    "<": {1: "latin-1", 2: "latin-1", 4: "utf-16-le", 16: "utf-8", 17: "utf-16-le", 18: "utf-32-le"},
    ">": {1: "latin-1", 2: "latin-1", 4: "utf-16-be", 16: "utf-8", 17: "utf-16-be", 18: "utf-32-be"},
}
_STRUCTURE, _TEXT, _NUMERIC = 2, 4, range(6, 16)
_COMPLEX_FLAG = 0x0800


class _Array(NamedTuple):
    """An array in the file: its class, name and shape, and the elements with its values."""

    kind: int
    is_complex: bool
    shape: tuple[int, ...]
    name: str
    parts: list[tuple[int, memoryview]]


def read_level_5(stream: BinaryIO, variable: str) -> NDArray[Any]:
    """Values of a variable: numbers, or text as an array of one string. ``"bearing.gs"`` is a field of a structure.

    Of all other variables only the names are read.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, or does not hold such a variable.
    """
    stream.seek(HEADER - 2)
    order = BYTE_ORDERS[stream.read(2)]
    wanted, *fields = variable.split(".")
    names: list[str] = []
    # a list, so that a truncated file is detected before the variable is read
    for kind, start, length in list(_variables(stream, order)):
        stream.seek(start)
        head = stream.read(min(length, _HEAD))
        _, _, name = _header(kind, head, order)
        if name == wanted:
            return _values(_field(_whole(stream, kind, start, length, order), fields, order), variable, order)
        names.append(name)
    message = f"holds {listing(names)}, not {wanted}"
    raise UnusableError(message)


def names_level_5(stream: BinaryIO) -> list[tuple[str, int]]:
    """Names of the real numeric arrays and of those in structures, as ``"bearing.gs"``, with their numbers of values.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged.
    """
    stream.seek(HEADER - 2)
    order = BYTE_ORDERS[stream.read(2)]
    found: list[tuple[str, int]] = []
    for kind, start, length in list(_variables(stream, order)):
        stream.seek(start)
        about, sides, name = _header(kind, stream.read(min(length, _HEAD)), order)
        if about & 0xFF == _STRUCTURE:
            found += _numeric(_whole(stream, kind, start, length, order), order)
        elif about & 0xFF in _NUMERIC and not about & _COMPLEX_FLAG:
            found.append((name, math.prod(sides)))
    return found


def _numeric(array: _Array, order: str, depth: int = 3) -> Iterator[tuple[str, int]]:
    """Names and sizes of the real numeric arrays that are an array or are in a structure, at most ``depth`` deep."""
    if array.kind in _NUMERIC and not array.is_complex:
        yield array.name, math.prod(array.shape)
    elif array.kind == _STRUCTURE and math.prod(array.shape) == 1 and depth:
        for field, (kind, data) in _fields(array, order).items():
            for name, size in _numeric(_array(kind, data, order)._replace(name=field), order, depth - 1):
                yield f"{array.name}.{name}", size


def _variables(stream: BinaryIO, order: str) -> Iterator[tuple[int, int, int]]:
    """Type, position and length of each element of the file."""
    position, end = HEADER, stream.seek(0, os.SEEK_END)
    for _ in range(_MOST):
        if position >= end:
            return
        stream.seek(position)
        kind, start, length = _tag(stream.read(8), order)
        if length > end - position - start:
            message = f"is truncated or damaged: {length} bytes announced where {end - position - start} are left"
            raise UnusableError(message)
        yield kind, position + start, length
        position += start + length
        if kind != _COMPRESSED:
            position += -position % 8
    message = f"is damaged: more than {_MOST} variables"
    raise UnusableError(message)


def _header(kind: int, head: bytes, order: str) -> tuple[int, tuple[int, ...], str]:
    """Class with flags, shape and name of a variable, from its first bytes."""
    if kind == _COMPRESSED:
        head = first_bytes(head, _HEAD)
        kind, start, _ = _tag(head[:8], order)
        head = head[start:]
    if kind != _MATRIX:
        message = f"is damaged: an element of type {kind} where an array should be"
        raise UnusableError(message)
    (_, flags), (_, shape), (_, name) = islice(_elements(memoryview(head), order), 3)
    sides = tuple(np.frombuffer(shape, order + "i4").tolist())
    return int(np.frombuffer(flags, order + "u4")[0]), sides, bytes(name).decode("latin-1")


def _whole(stream: BinaryIO, kind: int, start: int, length: int, order: str) -> _Array:
    """A variable with its values."""
    stream.seek(start)
    if kind != _COMPRESSED:
        check_size(length, length)
        return _array(kind, memoryview(stream.read(length)), order)
    check_limit("file_bytes", length, "holds", UnusableError)
    compressed = stream.read(length)
    _, begin, inside = _tag(first_bytes(compressed[:_HEAD], 8), order)
    unfolded = unfold(compressed, begin + inside).data
    return _array(*next(_elements(unfolded, order)), order)


def _tag(tag: bytes | memoryview, order: str) -> tuple[int, int, int]:
    """Type of an element, offset of its bytes from the start of its tag, and their number."""
    kind, length = np.frombuffer(tag, order + "u4", 2).tolist()
    return (kind & 0xFFFF, 4, kind >> 16) if kind >> 16 else (kind, 8, length)


def _elements(data: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Type and bytes of each element; up to four bytes are stored in place of the length."""
    position = 0
    while position < len(data):
        kind, start, length = _tag(data[position : position + 8], order)
        room = 4 if start == 4 else len(data) - position - 8
        if length > room:
            message = f"is truncated or damaged: {length} bytes announced where {room} are left"
            raise UnusableError(message)
        yield kind, data[position + start : position + start + length]
        position += start + length
        if kind != _COMPRESSED:
            position += -position % 8


def _array(kind: int, data: memoryview, order: str) -> _Array:
    if kind != _MATRIX:
        message = f"is damaged: an element of type {kind} where an array should be"
        raise UnusableError(message)
    (_, flags), (_, shape), (_, name), *parts = islice(_elements(data, order), 3 + _MOST)
    (flag, *_) = np.frombuffer(flags, order + "u4").tolist()
    sides = tuple(np.frombuffer(shape, order + "i4").tolist())
    return _Array(flag & 0xFF, bool(flag & _COMPLEX_FLAG), sides, bytes(name).decode("latin-1"), parts)


def _field(array: _Array, fields: list[str], order: str) -> _Array:
    """Field of nested structures, each of one element."""
    for field in fields:
        if array.kind != _STRUCTURE or math.prod(array.shape) != 1:
            message = f"holds {array.name or 'a field'}, but it is not one structure with the field {field}"
            raise UnusableError(message)
        held = _fields(array, order)
        if field not in held:
            message = f"holds a structure of {listing([*held])}, not {field}"
            raise UnusableError(message)
        array = _array(*held[field], order)
    return array


def _fields(array: _Array, order: str) -> dict[str, tuple[int, memoryview]]:
    """Type and bytes of each field of a structure of one element, by name."""
    (_, width), (_, text), *values = array.parts
    (size,) = np.frombuffer(width, order + "i4").tolist()
    if not 0 < size <= _LONGEST_FIELD or len(text) > size * _MOST:
        message = f"is damaged: {len(text)} bytes of field names of {size} each"
        raise UnusableError(message)
    names = [bytes(text[at : at + size]).rstrip(b"\0").decode("latin-1") for at in range(0, len(text), size)]
    return dict(zip(names, values, strict=True))


def _values(array: _Array, variable: str, order: str) -> NDArray[Any]:
    if array.kind not in (_TEXT, *_NUMERIC) or array.is_complex:
        message = f"holds {variable}, but neither real numbers nor text in it"
        raise UnusableError(message)
    kind, data = array.parts[0]
    known = _TEXTS[order] if array.kind == _TEXT else _NUMBERS
    if kind not in known:
        message = f"is damaged: values of unknown type {kind} in {variable}"
        raise UnusableError(message)
    if array.kind == _TEXT:
        if len(data) > _LONGEST_TEXT:
            message = f"holds {variable}, but it is a text of {len(data)} bytes"
            raise UnusableError(message)
        return np.array(bytes(data).decode(known[kind]))
    return np.frombuffer(data, order + known[kind]).reshape(array.shape, order="F")


def listing(names: list[str]) -> str:
    """First names of a list, and the number of the others."""
    shown = ", ".join(name[:63] for name in names[:6]) or "nothing"
    return f"{shown} and {len(names) - 6} more" if len(names) > 6 else shown
