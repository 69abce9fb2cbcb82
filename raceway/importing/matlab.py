"""One variable of a MATLAB file: levels 4 to 7 with SciPy, level 7.3, which is HDF5, with h5py.

Data sets name the same variable differently in every file. So a name can have a ``*`` for any letters, and no name means the only signal
in the file.
"""

import re
import struct
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.trust import LIBRARY_LOCK, ForeignStorageError, own_dataset
from raceway.importing.array_files import UnusableError, guarded
from raceway.importing.axes import axes_of
from raceway.importing.header import Header, unit_said
from raceway.importing.numerals import number_in
from raceway.importing.table import NumberTable, table_of

_FEWEST = 100  # values of a signal; speeds and rates have one
_REAL = "biuf"  # kinds of NumPy types
_TABLES = (b"table", b"timetable", "table", "timetable")
_RATE = re.compile(r"sr|fs|samp(?:le|ling)?_?(?:rate|freq(?:uency)?)", re.IGNORECASE)
_BYTES_OF_LEVEL_4 = (8, 4, 4, 2, 2, 1)  # of a value, by the type of the numbers


class Held(NamedTuple):
    """A variable, real numbers or text, and the first of the few numbers in each other variable, by their names."""

    name: str
    values: NDArray[Any]
    numbers: Mapping[str, float]


def read_matlab(path: Path, variable: str | None) -> Held:
    """Variable of a MATLAB file; ``"bearing.gs"`` is a field of a structure, ``"Y[6].Data"`` one of its seventh element.

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
    with guarded(path, "MATLAB"):
        with LIBRARY_LOCK:
            in_hdf5 = h5py.is_hdf5(path)
        return _read_hdf5(path, variable) if in_hdf5 else _read_level_5(path, variable)


def read_matlab_table(path: Path, variable: str | None) -> NumberTable:
    """Table in a variable, with sample rates and speed that variables beside it or of the whole file state."""
    name, values, numbers = read_matlab(path, variable)
    near = {key: number for key, number in numbers.items() if key.rpartition(".")[0] in ("", name.rpartition(".")[0])}
    rates = dict.fromkeys(number for key, number in near.items() if _RATE.fullmatch(key.rpartition(".")[2]))
    speeds = {key[:-3]: number for key, number in near.items() if key.lower().endswith("rpm")}
    own = [number for start, number in speeds.items() if start and name.startswith(start)] or [*speeds.values()]
    return table_of(values)._replace(header=Header(rates=tuple(rates)), rpm=own[0] if len(own) == 1 else None)


def _content(path: Path) -> dict[str, Any]:
    """Variables, and in place of structures their fields."""
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


def _read_level_5(path: Path, variable: str | None) -> Held:
    variables = {key: np.asarray(value) for key, value in _content(path).items() if not isinstance(value, list)}
    sizes = {key: value.size for key, value in variables.items() if value.dtype.kind in _REAL}
    name = _whole_name(variable) or _only(sizes, variable)
    if name not in variables:
        raise UnusableError(f"holds {listing([*variables])}, not {name}")
    if variables[name].dtype.kind not in _REAL + "U":
        raise UnusableError(f"holds {name}, but neither real numbers nor text in it")
    few = {
        key: value.flat[0]
        for key, value in variables.items()
        if value.dtype.kind in _REAL + "U" and 0 < value.size < _FEWEST
    }
    numbers = {key: number_in(value) if isinstance(value, str) else float(value) for key, value in few.items()}
    return Held(name, variables[name], {key: number for key, number in numbers.items() if number is not None})


def _whole_name(variable: str | None) -> str | None:
    return None if variable is None or "*" in variable else variable


def _read_hdf5(path: Path, variable: str | None) -> Held:
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
            return Held(name, np.empty(0), {})
        values = np.asarray(dataset)
        few = {key: own_dataset(file, key.replace(".", "/")) for key, size in sizes.items() if 0 < size < _FEWEST}
        numbers = {key: float(np.asarray(number).flat[0]) for key, number in few.items()}
        return Held(name, _text(values) if _is_text(dataset) else values, numbers)


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
        raise UnusableError(f"holds {listing([*held])}, and no {wanted}; name one", "variable")
    axes = _axes(held, names) if pattern is None else ()
    raise UnusableError(f"holds {listing(names)}, more than one {wanted}; name one", "variable", axes=axes)


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
