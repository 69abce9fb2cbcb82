"""Numbers in text, NumPy and WAV files, and the one place where an error of a library becomes a sentence.

Every error becomes an :class:`UnusableError` with a reason and without the name of the file: the caller adds the name.
"""

import codecs
import errno
import os
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.support.limits import check_limit

FloatArray = NDArray[np.floating]

_HEAD_LINES = 100
_START = 2_000_000  # bytes that tell the encoding
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
_WITH_REASON = (ValueError, OSError, EOFError, Warning)  # of a library; the text of others is about its code
_NO_NUMBER = re.compile(r"[^\d\s.,;eE+-]")


class UnusableError(Exception):
    """Reason why a file cannot be used; its text has no full stop, because a sentence about the file goes on after it."""

    def __str__(self) -> str:
        return super().__str__().removesuffix(".")


def read_text(path: Path, column: int | str | None = None, delimiter: str | None = None) -> NDArray[np.float64]:
    """Columns of a delimited text file, shape (time,) for one ``column`` and (time, column) for all.

    Lines before the first line of numbers are a header. ``column`` is a number, from 0, or a name in the header. The default of
    ``delimiter`` is the tab, semicolon or comma found in the first lines, or blanks.

    Raises
    ------
    UnusableError
        If the file is not such a text, or does not have the column.
    """
    with guarded(path, "delimited text"):
        encoding = _encoding(path)
        with path.open(encoding=encoding, errors="replace") as text:
            head = [line.rstrip("\r\n").lstrip("#") for line in islice(text, _HEAD_LINES)]
        separator = delimiter or next((mark for mark in "\t;," if any(mark in line for line in head)), None)
        _check_commas(head, separator)
        lines = [[field.strip() for field in line.split(separator)] for line in head]
        index, first = _locate(lines, column)
        return np.loadtxt(path, delimiter=separator, skiprows=first, usecols=index, ndmin=1, encoding=encoding)


def _encoding(path: Path) -> str:
    """Encoding of a text by its beginning: UTF-16 has a mark, and what is no UTF-8 is read as Latin-1."""
    with path.open("rb") as stream:
        start = stream.read(_START)
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    try:
        codecs.getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def _check_commas(head: list[str], separator: str | None) -> None:
    """Refuse decimal commas. Of a comma between whole numbers, two in each line, it is one if some second number is like 05."""
    lines = [line.strip() for line in head if line.strip() and not _NO_NUMBER.search(line)]
    if separator == ",":
        refused = all(map(_DECIMAL_COMMA.fullmatch, lines)) and any(re.search(r",0\d", line) for line in lines)
    else:
        fields = [re.split(r"[;\s]+", line) for line in lines if "," in line]
        refused = any(all(_DECIMAL_COMMA.fullmatch(field) or field.isdecimal() for field in each) for each in fields)
    if refused:
        raise UnusableError("has numbers with decimal commas; save it with decimal points")


def read_numpy(path: Path) -> NDArray[Any]:
    """Array in a NumPy ``.npy`` file; pickled objects are refused.

    Raises
    ------
    UnusableError
        If the file is not a NumPy file.
    """
    with guarded(path, "NumPy"):
        # a memory map compares the size in the header with the file before anything is allocated
        return np.array(np.lib.format.open_memmap(path, mode="r"))


def read_wav(path: Path) -> tuple[NDArray[Any], float, float]:
    """Samples of a WAV file as stored, shape (time, channel), their full scale (1 for floating point), and the sample rate [Hz].

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, is not a WAV file, or is compressed.
    """
    from scipy.io import wavfile

    with guarded(path, "WAV"):
        warnings.filterwarnings("error", "Reached EOF prematurely")
        rate, samples = wavfile.read(path)
        if samples.dtype.kind == "f":
            return samples, 1.0, float(rate)
        full_scale = 2.0 ** (8 * samples.itemsize - 1)
        return samples if samples.dtype.kind == "i" else samples.astype(np.int16) - 128, full_scale, float(rate)


def one_column(values: NDArray[Any], column: int | None = None) -> FloatArray:
    """Vector of real numbers, shape (time,).

    In a table the longer axis is time; ``column`` is a number along the other axis.

    >>> one_column(np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), 1)
    array([4., 5., 6.])

    Raises
    ------
    UnusableError
        If the values are not real numbers, not a table, or a table of several columns without a chosen one.
    """
    if values.dtype.kind not in "iuf" or values.size == 0 or values.ndim > 2:
        message = f"holds {values.dtype} of shape {values.shape}, not one column of real numbers"
        raise UnusableError(message)
    columns = np.atleast_2d(values)
    if columns.shape[0] > columns.shape[1]:
        columns = columns.T
    if column is None and columns.shape[0] > 1:
        message = f"has {columns.shape[0]} columns and none is chosen; choose one with column"
        raise UnusableError(message)
    chosen = column or 0
    if not 0 <= chosen < columns.shape[0]:
        message = f"has columns 0 to {columns.shape[0] - 1}, not {chosen}; give another column"
        raise UnusableError(message)
    return columns[chosen].astype(np.float64, copy=False)


@contextmanager
def guarded(path: Path, kind: str) -> Iterator[None]:
    """Check the size of a file before a library reads it, and turn each of the library's errors into an :class:`UnusableError`.

    Raises
    ------
    UnusableError
        If the file is empty or above the limit ``file_bytes``, or the library fails.
    OSError
        If the file is missing, not readable, or a folder, a pipe or a device.
    MemoryError
        If its values do not fit in memory.
    """
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "is a folder, a pipe or a device", str(path))
    with path.open("rb") as stream:
        size = os.fstat(stream.fileno()).st_size
    if size == 0:
        raise UnusableError("is empty (0 bytes); copy it again")
    check_limit("file_bytes", size, "is", UnusableError)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (UnusableError, MemoryError):
        raise
    except Exception as error:  # SciPy, h5py and NumPy raise a dozen unrelated types on damaged bytes
        reason = f" ({str(error).splitlines()[0][:120]})" if isinstance(error, _WITH_REASON) and str(error) else ""
        message = f"is truncated, damaged or not a {kind} file{reason}"
        raise UnusableError(message) from error


def reason_of(error: OSError | MemoryError) -> str:
    """Reason why a file could not be read, and advice."""
    if isinstance(error, MemoryError):
        return "holds more values than fit in memory; cut it into shorter files"
    return f"could not be read ({error.strerror or error}); check the path"


def _locate(lines: list[list[str]], column: int | str | None) -> tuple[int | None, int]:
    """Index of the column and number of the first line of numbers."""
    header = 0
    if isinstance(column, str):
        header = next((number for number, fields in enumerate(lines, start=1) if column in fields), 0)
        if not header:
            message = f"has no column {column} in its first {len(lines)} lines"
            raise UnusableError(message)
        column = lines[header - 1].index(column)
    chosen = slice(None) if column is None else slice(column, column + 1)
    for number, fields in enumerate(lines[header:], start=header):
        if _are_numbers(fields[chosen]):
            return column, number
    where = "" if column is None else f" in column {column}"
    message = f"has no line of numbers{where} among its first {len(lines)}"
    raise UnusableError(message)


def _are_numbers(fields: list[str]) -> bool:
    try:
        [float(field) for field in fields]
    except ValueError:
        return False
    return bool(fields)
