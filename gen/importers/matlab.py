"""One variable of a MATLAB file, level 5 or 7.3 (HDF5); damaged files are refused with a reason.

Data sets name the same variable differently in every file. So a name can have a ``*`` for any letters, and no name means the only signal
in the file.
"""

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.importers.apart import read_apart
from gen.importers.files import UnusableError, guarded
from gen.importers.level_5 import BYTE_ORDERS, HEADER, listing, names_level_5, read_level_5
from gen.importers.level_7_3 import names_level_7_3, read_level_7_3
from gen.plain_files import open_plain

_HDF5_MAGIC = b"\x89HDF\r\n\x1a\n"
_HDF5_OFFSET = 512  # a file of level 7.3 has a MATLAB header before the HDF5 content
_FEWEST = 100  # values of a signal; speeds and rates have one


def read_matlab(path: Path, variable: str | None) -> NDArray[Any]:
    """Numbers, or text as an array of one string; ``"bearing.gs"`` is a field of a structure.

    Values above the limit ``file_bytes``, or far larger than their storage, are refused before they are read.

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
    """
    with open_plain(path) as stream:
        head = stream.read(_HDF5_OFFSET + len(_HDF5_MAGIC))
        if _HDF5_MAGIC not in (head[: len(_HDF5_MAGIC)], head[_HDF5_OFFSET:]):
            if head[HEADER - 2 : HEADER] not in BYTE_ORDERS:
                raise UnusableError("is not a MATLAB file of level 5 or 7.3")
            if variable is None or "*" in variable:
                variable = _only(guarded("MATLAB", lambda: names_level_5(stream)), variable)
            name = variable
            return guarded("MATLAB", lambda: read_level_5(stream, name))
        size = os.fstat(stream.fileno()).st_size
    if variable is None or "*" in variable:
        held = guarded("MATLAB 7.3", lambda: read_apart(lambda: np.array(names_level_7_3(path)), size))
        variable = _only([(str(name), int(count)) for name, count in held], variable)
    name = variable
    return guarded("MATLAB 7.3", lambda: read_apart(lambda: read_level_7_3(path, name), size))


def _only(held: list[tuple[str, int]], pattern: str | None) -> str:
    """Name of the only variable that matches a pattern, or without one of the only signal."""
    names = [name for name, count in held if (count >= _FEWEST if pattern is None else matches(name, pattern))]
    if len(names) == 1:
        return names[0]
    wanted = f"variable with {_FEWEST} numbers or more" if pattern is None else f"variable {pattern}"
    if not names:
        message = f"holds {listing([name for name, _ in held])}, and no {wanted}; name one with variable"
    else:
        message = f"holds {listing(names)}, more than one {wanted}; name one with variable"
    raise UnusableError(message)


def matches(name: str, pattern: str) -> bool:
    """Whether a name fits a pattern, in which ``*`` stands for any letters; takes time in proportion to their lengths.

    >>> [matches("X097_DE_time", pattern) for pattern in ("X*_DE_time", "X*E_time", "*", "X*_FE_time", "X097_DE_time*X")]
    [True, True, True, False, False]
    """
    first, *others = pattern.split("*")
    if not others or not name.startswith(first):
        return name == pattern
    place = len(first)
    for part in others[:-1]:
        place = name.find(part, place)
        if place < 0:
            return False
        place += len(part)
    return len(name) - place >= len(others[-1]) and name.endswith(others[-1])
