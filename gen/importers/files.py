"""Columns of numbers in text and NumPy files.

Every error becomes an :class:`UnusableError` with a reason and without the name of the file: the caller adds the name.
"""

import codecs
import io
import os
import re
import warnings
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO, TextIO, TypeVar

import numpy as np
from numpy.typing import NDArray

from gen.limits import check_limit
from gen.plain_files import open_plain

FloatArray = NDArray[np.floating]
Value = TypeVar("Value")

_HEAD_LINES = 100
_LONGEST_LINE = 2_000_000  # characters; a whole recording can be on one line
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
_NO_NUMBER = re.compile(r"[^\d\s.,;eE+-]")


class UnusableError(Exception):
    """Reason why a file cannot be used."""


def read_text(path: Path, column: int | str | None = None, delimiter: str | None = None) -> NDArray[np.float64]:
    """Columns of a delimited text file, shape (time,) for one ``column`` and (time, column) for all.

    Lines before the first line of numbers are a header. ``column`` is a number, from 0, or a name in the header. The default of
    ``delimiter`` is the tab, semicolon or comma found in the first lines, or blanks.

    Raises
    ------
    UnusableError
        If the file is not such a text, or does not have the column.
    """
    with open_plain(path) as stream:
        check_limit("file_bytes", os.fstat(stream.fileno()).st_size, "is", UnusableError)
        _check_lines(stream)
        encoding = _encoding(stream)
        text = io.TextIOWrapper(stream, encoding=encoding, errors="replace")
        head = [line.rstrip("\r\n").lstrip("#") for line in _head(text)]
    separator = delimiter or next((mark for mark in "\t;," if any(mark in line for line in head)), None)
    _check_commas(head, separator)
    lines = [[field.strip() for field in line.split(separator)] for line in head]
    index, first = _locate(lines, column)

    def load() -> NDArray[np.float64]:
        return np.loadtxt(path, delimiter=separator, skiprows=first, usecols=index, ndmin=1, encoding=encoding)

    return guarded("delimited text", load)


def _check_lines(stream: BinaryIO) -> None:
    """Refuse a text with a very long line: splitting it takes ten times its length in memory."""
    while block := stream.read(_LONGEST_LINE):
        if len(block) == _LONGEST_LINE and b"\n" not in block and b"\r" not in block:
            message = f"has a line of more than {_LONGEST_LINE} characters"
            raise UnusableError(message)
    stream.seek(0)


def _encoding(stream: BinaryIO) -> str:
    """Encoding of a text by its beginning: UTF-16 has a mark, and what is no UTF-8 is read as Latin-1."""
    start = stream.read(_LONGEST_LINE)
    stream.seek(0)
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


def _head(text: TextIO) -> list[str]:
    """First lines of a text, which can contain the header."""
    head: list[str] = []
    for line in islice(text, _HEAD_LINES):
        head.append(line)
        if sum(map(len, head)) > _LONGEST_LINE:
            break
    return head


def read_numpy(path: Path) -> NDArray[Any]:
    """Array in a NumPy ``.npy`` file; pickled objects are refused.

    Raises
    ------
    UnusableError
        If the file is not a NumPy file.
    """
    with open_plain(path) as stream:
        check_limit("file_bytes", os.fstat(stream.fileno()).st_size, "is", UnusableError)
    # a memory map compares the size in the header with the file before anything is allocated
    return guarded("NumPy", lambda: np.array(np.lib.format.open_memmap(path, mode="r")))


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


def guarded(kind: str, read: Callable[[], Value]) -> Value:
    """Result of ``read``; every error becomes an :class:`UnusableError`."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return read()
    except UnusableError:
        raise
    except Exception as error:  # zlib, h5py and NumPy raise a dozen unrelated types on damaged bytes
        reason = str(error).splitlines()[0][:120] if str(error) else type(error).__name__
        message = f"is not a readable {kind} file ({reason})"
        raise UnusableError(message) from error


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
