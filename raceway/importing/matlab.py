"""Variables of MATLAB files, levels 4 to 7 by SciPy and level 7.3, which is HDF5, by h5py; and of NumPy archives.

Data sets name the same variable differently in every file. So a name can have a ``*`` for any letters, and no name means the only signal
in the file.
"""

import re
import struct
import zipfile
import zlib
from collections.abc import Container, Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.trust import LIBRARY_LOCK, ForeignStorageError, own_dataset
from gen.support.display import first_few
from gen.support.limits import check_limit, limit
from raceway.importing.axes import axes_of
from raceway.importing.header import Header, unit_said
from raceway.importing.numerals import number_in
from raceway.importing.refused_files import UnusableError, guarded
from raceway.importing.table import NumberTable, table_of

_FEWEST = 100  # values of a signal; speeds and rates have one
_REAL = "biuf"  # kinds of NumPy types
_TABLES = (b"table", b"timetable", "table", "timetable")
_RATE = re.compile(r"sr|fs|samp(?:le|ling)?_?(?:rate|freq(?:uency)?)", re.IGNORECASE)
_MATRIX, _COMPRESSED = 14, 15  # types of elements of level 5
_TYPES_OF_VALUES = {1, 2, 3, 4, 5, 6, 7, 9, 12, 13, 16, 17, 18}
_CLASSES_OF_NUMBERS = range(4, 16)  # text and sparse ones too
_BYTES_OF_LEVEL_4 = (8, 4, 4, 2, 2, 1)  # of a value, by the type of the numbers


def read_variable(path: Path, variable: str | None) -> NumberTable:
    """Table in a variable, with sample rates and speed that variables beside it or of the whole file state.

    Parameters
    ----------
    path : Path
        The file.
    variable : str or None
        Name of the variable, with ``*`` for any letters; one variable of real numbers must match. None for the only one with 100 values
        or more. ``"bearing.gs"`` is a field of a structure, ``"Y[6].Data"`` one of its seventh element.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, is not a MATLAB file, or does not hold the variable.
    OSError
        If the file cannot be opened.
    """
    if path.suffix.lower() == ".npz":
        with guarded(path, "NumPy"), zipfile.ZipFile(path) as archive:
            check_limit("file_bytes", sum(part.file_size for part in archive.infolist()), "is unpacked", UnusableError)
            with np.load(path) as variables:
                return _table(dict(variables), variable)
    with guarded(path, "MATLAB"):
        with LIBRARY_LOCK:
            in_hdf5 = h5py.is_hdf5(path)
        if not in_hdf5:
            return _table(_content(path), variable)
        with LIBRARY_LOCK, h5py.File(path, "r") as file:
            return _table(_datasets(file, variable), variable)


def _table(variables: Mapping[str, Any], variable: str | None) -> NumberTable:
    sizes = {
        key: value.size or 0 for key, value in variables.items() if value.dtype.kind in _REAL and not _is_text(value)
    }
    name = _only(sizes, variable) if variable is None or "*" in variable else variable
    if name not in variables:
        raise UnusableError(f"holds {_listing(variables)}, not {name}; name one", "variable")
    if variables[name].dtype.kind not in _REAL + "U" or variables[name].shape is None:
        raise UnusableError(f"holds {name}, but neither real numbers nor text in it")
    # speeds and sample rates are beside the variable, or of the whole file
    rates: dict[float, None] = {}
    speeds: dict[str, float] = {}
    for key, value in variables.items():
        structure, _, field = key.rpartition(".")
        if structure not in ("", name.rpartition(".")[0]) or not 0 < (value.size or 0) < _FEWEST:
            continue
        number = _number(value) if _RATE.fullmatch(field) or field.lower().endswith("rpm") else None
        if number is not None and _RATE.fullmatch(field):
            rates[number] = None
        elif number is not None:
            speeds[key[:-3]] = number
    own = [number for start, number in speeds.items() if start and name.startswith(start)] or [*speeds.values()]
    values = np.empty(0) if getattr(variables[name], "attrs", {}).get("MATLAB_empty") else np.asarray(variables[name])
    rpm = own[0] if len(own) == 1 else None
    return table_of(values)._replace(header=Header(rates=tuple(rates)), rpm=rpm, variable=name)


def _number(value: Any) -> float | None:
    """Number in a variable, which may be text; None if its values differ."""
    values = np.asarray(value)
    if _is_text(value):
        return number_in(str(values.item()) if values.dtype.kind == "U" else "".join(map(chr, values.flat)))
    plain = values.dtype.kind in _REAL and bool(np.all(values == values.flat[0]))
    return float(values.flat[0]) if plain else None


def _is_text(value: Any) -> bool:
    return value.dtype.kind == "U" or getattr(value, "attrs", {}).get("MATLAB_class") in (b"char", "char")


def _content(path: Path) -> dict[str, NDArray[Any]]:
    """Variables, and in place of structures their fields."""
    from scipy.io import loadmat  # loads scipy.sparse
    from scipy.io.matlab import matfile_version

    if matfile_version(path)[0] == 0:
        _check_level_4(path)
    else:
        content = np.memmap(path, mode="r").data  # of which the types alone are read
        order = "<" if content[126:128] == b"IM" else ">"
        _check_elements(content[128:], order, {_MATRIX, _COMPRESSED})
    variables: dict[str, NDArray[Any]] = {}

    def add(name: str, value: Any) -> None:
        if isinstance(value, dict):
            for field, inner in value.items():
                add(f"{name}.{field}", inner)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for number, inner in enumerate(value):
                add(f"{name}[{number}]", inner)
        elif not isinstance(value, list):
            variables[name] = np.asarray(value)

    for name, value in loadmat(path, simplify_cells=True).items():
        if not name.startswith("__"):
            add(name, value)
    return variables


def _check_level_4(path: Path) -> None:
    """Refuse variables without a name: SciPy takes 20 zero bytes for one, and hours for a file that ends in many."""
    with path.open("rb") as stream:
        while head := stream.read(20):
            order = "<" if 0 <= int.from_bytes(head[:4], "little", signed=True) <= 9999 else ">"
            kind, rows, columns, imaginary, length = struct.unpack(f"{order}5i", head)
            if length < 2 or min(rows, columns) < 0:
                raise ValueError("a variable has no name or no size")
            size = rows * columns * _BYTES_OF_LEVEL_4[kind // 10 % 10] * (2 if imaginary else 1)
            stream.seek(length + size, 1)


def _check_elements(content: memoryview, order: str, allowed: Container[int]) -> None:
    """Refuse elements of another type than their place has: of a number of no known type, SciPy ends the process."""
    place = 0
    while place + 8 <= len(content):
        kind, size = struct.unpack_from(f"{order}2I", content, place)
        place += 8
        if kind >> 16:  # at most four bytes lie beside the type
            kind, size = kind & 0xFFFF, 0
        if kind not in allowed:
            raise ValueError(f"a value has the type {kind}")
        inner = content[place : place + size]
        place += size if kind == _COMPRESSED else size + -size % 8
        if kind == _COMPRESSED:
            most = limit("file_bytes")
            unpacked = zlib.decompressobj().decompress(inner, most + 1)
            check_limit("file_bytes", len(unpacked), "is unpacked", UnusableError)
            _check_elements(memoryview(unpacked), order, {_MATRIX})
        elif kind == _MATRIX and size:
            numbers = inner[8 if order == "<" else 11] in _CLASSES_OF_NUMBERS
            _check_elements(inner, order, _TYPES_OF_VALUES if numbers else {*_TYPES_OF_VALUES, _MATRIX})


def _datasets(file: h5py.File, variable: str | None) -> dict[str, h5py.Dataset]:
    """Datasets whose values are in the file; ``#refs#`` holds the contents of cells."""
    names: list[str] = []

    def note(name: str, node: Any) -> None:
        if node.attrs.get("MATLAB_class") in _TABLES:
            raise UnusableError(f"holds {name}, which is a table; save its columns as arrays of numbers")
        if isinstance(node, h5py.Dataset) and not name.startswith("#"):
            names.append(name)

    file.visititems(note)
    # a link is not visited, and told if it is asked for
    asked = "" if variable is None else variable.replace(".", "/")
    names += [asked] if asked in file and asked not in names else []
    try:
        return {name.replace("/", "."): own_dataset(file, name) for name in names}
    except ForeignStorageError as error:
        raise UnusableError(f"refers to values outside the file: {error}") from None


def _only(held: Mapping[str, int], pattern: str | None) -> str:
    """Name of the only variable that matches a pattern, or without one of the only signal."""
    names = [
        name for name, count in held.items() if (count >= _FEWEST if pattern is None else fnmatchcase(name, pattern))
    ]
    if len(names) == 1:
        return names[0]
    wanted = f"variable with {_FEWEST} numbers or more" if pattern is None else f"variable {pattern}"
    if not names:
        raise UnusableError(f"holds {_listing(held)}, and no {wanted}; name one", "variable")
    axes = _axes(held, names) if pattern is None else ()
    raise UnusableError(f"holds {_listing(names)}, more than one {wanted}; name one", "variable", axes=axes)


def _axes(held: Mapping[str, int], names: Sequence[str]) -> tuple[str, ...]:
    """Variables of one length that are the axes of one sensor."""
    if len({held[name] for name in names}) > 1:
        return ()
    header = Header(tuple(names), tuple(map(unit_said, names)))
    return tuple(names[n] for n in axes_of(header, [n for n in range(len(names)) if not header.is_of_time(n)]))


def _listing(names: Iterable[str]) -> str:
    """First names of a list, and the number of the others."""
    return first_few((name[:63] for name in names), 6) or "nothing"
