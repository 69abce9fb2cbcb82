"""One variable of a MATLAB file, level 5 or 7.3 (HDF5); damaged files are refused with a reason."""

import os
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from gen.importers.apart import read_apart
from gen.importers.files import UnusableError, guarded
from gen.importers.level_5 import BYTE_ORDERS, HEADER, read_level_5
from gen.importers.level_7_3 import read_level_7_3
from gen.plain_files import open_plain

_HDF5_MAGIC = b"\x89HDF\r\n\x1a\n"
_HDF5_OFFSET = 512  # a file of level 7.3 has a MATLAB header before the HDF5 content


def read_matlab(path: Path, variable: str) -> NDArray[Any]:
    """Numbers, or text as an array of one string; ``"bearing.gs"`` is a field of a structure.

    Values above the limit ``file_bytes``, or far larger than their storage, are refused before they are read.

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
            return guarded("MATLAB", lambda: read_level_5(stream, variable))
        size = os.fstat(stream.fileno()).st_size
    return guarded("MATLAB 7.3", lambda: read_apart(lambda: read_level_7_3(path, variable), size))
