"""One variable of a MATLAB file: levels 4 to 7 with SciPy, level 7.3, which is HDF5, with h5py.

Data sets name the same variable differently in every file. So a name can have a ``*`` for any letters, and no name means the only signal
in the file.
"""

import math
import re
import struct
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import islice
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.hdf5 import LIBRARY_LOCK, ForeignStorageError, own_dataset
from raceway.importing.axes import axes_of
from raceway.importing.files import NoneChosenError, UnusableError, guarded
from raceway.importing.header import Header, unit_said
from raceway.importing.table import Table, as_columns, table_of

_FEWEST = 100  # values of a signal; speeds and rates have one
_REAL = "biuf"  # kinds of NumPy types
_TABLES = (b"table", b"timetable", "table", "timetable")
_RATE = re.compile(r"sr|fs|samp(?:le|ling)?_?(?:rate|freq(?:uency)?)", re.IGNORECASE)
_BYTES_OF_LEVEL_4 = (8, 4, 4, 2, 2, 1)  # of a value, by the type of the numbers


def read_matlab(path: Path, variable: str | None) -> NDArray[Any]:
    """Numbers, or text as an array of one string; ``"bearing.gs"`` is a field of a structure.

    Parameters
    ----------
    path : Path
        The file.
    variable : str or None
        Name of the variable, with ``*`` for any letters; one variable of real numbers must match. None for the only one with 100 values
        or more.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, is not a MATLAB file, or does not hold the variable.
    OSError
        If the file cannot be opened.
    """
    return _read(path, variable)[1]


def read_matlab_table(path: Path, variable: str | None) -> Table:
    """Table in a variable, with the sample rates that variables beside it or of the whole file state; errors as in :func:`read_matlab`."""
    name, values, scalars = _read(path, variable)
    near = {key: number for key, number in scalars.items() if key.rpartition(".")[0] in ("", name.rpartition(".")[0])}
    rates = dict.fromkeys(number for key, number in near.items() if _RATE.fullmatch(key.rpartition(".")[2]))
    speeds = {key: number for key, number in near.items() if key.lower().endswith("rpm")}
    own = {key: number for key, number in speeds.items() if key[: -len("rpm")] and name.startswith(key[: -len("rpm")])}
    (rpm,) = (own or speeds).values() if len(own or speeds) == 1 else (None,)
    return table_of(values)._replace(header=Header(rates=tuple(rates)), rpm=rpm)


def _read(path: Path, variable: str | None) -> tuple[str, NDArray[Any], dict[str, float]]:
    """Name and values of a variable, and all single numbers of the file by name."""
    with guarded(path, "MATLAB"):
        with LIBRARY_LOCK:
            in_hdf5 = h5py.is_hdf5(path)
        return _read_hdf5(path, variable) if in_hdf5 else _read_level_5(path, variable)


def read_number(path: Path, variable: str | None) -> float:
    """Number in a file, which can be a text or the first of several; NaN if it is neither. Errors as in :func:`read_matlab`."""
    value = read_matlab(path, variable)
    try:
        return float(value.item() if value.size == 1 else as_columns(value)[0, 0])
    except ValueError:
        return math.nan


def _content(path: Path) -> dict[str, Any]:
    """Variables, and in place of structures their fields, as ``"bearing.gs"`` or ``"Y[6].Data"``."""
    from scipy.io import loadmat  # loads scipy.sparse
    from scipy.io.matlab import matfile_version

    if matfile_version(path)[0] == 0:
        _check_level_4(path)
    variables: dict[str, Any] = {}

    def add(name: str, value: Any) -> None:
        if isinstance(value, dict):
            for field, inner in value.items():
                add(f"{name}.{field}", inner)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for number, inner in enumerate(value):
                add(f"{name}[{number}]", inner)
        else:
            variables[name] = value

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


def _read_level_5(path: Path, variable: str | None) -> tuple[str, NDArray[Any], dict[str, float]]:
    variables = _content(path)
    arrays = {key: np.asarray(value) for key, value in variables.items() if _is_array(value, _REAL)}
    name = _whole_name(variable) or _only({key: value.size for key, value in arrays.items()}, variable)
    if name not in variables:
        message = f"holds {listing([*variables])}, not {name}"
        raise UnusableError(message)
    if not _is_array(variables[name], _REAL + "U"):
        message = f"holds {name}, but neither real numbers nor text in it"
        raise UnusableError(message)
    scalars = {key: float(value.item()) for key, value in arrays.items() if value.size == 1}
    return name, np.asarray(variables[name]), scalars


def _whole_name(variable: str | None) -> str | None:
    return None if variable is None or "*" in variable else variable


def _is_array(value: Any, kinds: str) -> bool:
    """Whether a value is an array of one of the kinds of NumPy types; a list is a cell with structures in it."""
    return not isinstance(value, list) and np.asarray(value).dtype.kind in kinds


def _read_hdf5(path: Path, variable: str | None) -> tuple[str, NDArray[Any], dict[str, float]]:
    with LIBRARY_LOCK, h5py.File(path, "r") as file:
        sizes = _sizes(file)
        name = _whole_name(variable) or _only(sizes, variable)
        try:
            dataset = own_dataset(file, name.replace(".", "/"))
        except ForeignStorageError as error:
            message = f"refers to values outside the file: {error}"
            raise UnusableError(message) from None
        except KeyError:
            message = f"holds {listing([*islice(file, 6)])}, not {name}"
            raise UnusableError(message) from None
        if dataset.dtype.kind not in _REAL or dataset.shape is None:
            message = f"holds {name}, but it is not real numbers"
            raise UnusableError(message)
        if dataset.attrs.get("MATLAB_empty"):  # it holds its dimensions
            return name, np.empty(0), {}
        values = np.asarray(dataset)
        single = {key: own_dataset(file, key.replace(".", "/")) for key, size in sizes.items() if size == 1}
        scalars = {key: float(np.asarray(number).item()) for key, number in single.items()}
        return name, _text(values) if _is_text(dataset) else values, scalars


def _is_text(dataset: h5py.Dataset) -> bool:
    return dataset.attrs.get("MATLAB_class") in (b"char", "char")


def _text(codes: NDArray[Any]) -> NDArray[np.str_]:
    """Text of character codes, one for each row; their first axis is the second of MATLAB."""
    return np.squeeze(["".join(map(chr, row)) for row in np.atleast_2d(codes.T)])


def _sizes(file: h5py.File) -> dict[str, int]:
    """Numbers of values of all real arrays, by name; ``#refs#`` holds the contents of cells."""
    sizes: dict[str, int] = {}

    def note(name: str, node: Any) -> None:
        if node.attrs.get("MATLAB_class") in _TABLES:
            raise UnusableError(f"holds {name}, which is a table; save its columns as arrays of numbers")
        numbers = isinstance(node, h5py.Dataset) and node.dtype.kind in _REAL and not _is_text(node)
        if numbers and not name.startswith("#"):
            sizes[name.replace("/", ".")] = node.size or 0

    file.visititems(note)
    return sizes


def _only(held: Mapping[str, int], pattern: str | None) -> str:
    """Name of the only variable that matches a pattern, or without one of the only signal."""
    names = [
        name for name, count in held.items() if (count >= _FEWEST if pattern is None else fnmatchcase(name, pattern))
    ]
    if len(names) == 1:
        return names[0]
    wanted = f"variable with {_FEWEST} numbers or more" if pattern is None else f"variable {pattern}"
    if not names:
        message = f"holds {listing([*held])}, and no {wanted}; name one"
    else:
        message = f"holds {listing(names)}, more than one {wanted}; name one"
        raise NoneChosenError(message, "variable", _axes(held, names) if pattern is None else ())
    raise UnusableError(message, "variable")


def _axes(held: Mapping[str, int], names: Sequence[str]) -> tuple[str, ...]:
    """Variables of one length that are the axes of one sensor."""
    if len({held[name] for name in names}) > 1:
        return ()
    header = Header(tuple(names), tuple(map(unit_said, names)))
    return tuple(names[n] for n in axes_of(header, [n for n in range(len(names)) if not header.is_of_time(n)]))


def listing(names: list[str]) -> str:
    """First names of a list, and the number of the others."""
    shown = ", ".join(name[:63] for name in names[:6]) or "nothing"
    return f"{shown} and {len(names) - 6} more" if len(names) > 6 else shown
