"""Tables in text: a header, rows of numbers, and perhaps a note at the end.

``encoding -> separator -> head -> columns to read -> numbers``
"""

import codecs
import re
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.importers.columns import Values, columns_to_read, signal_of, table_signal
from gen.importers.files import UnusableError, guarded
from gen.importers.header import Head, head_of, is_number, numbers_in, pattern_of

_HEAD_LINES = 200
_START = 2_000_000  # bytes that tell the encoding
_COMMENT = re.compile(r"^\s*(?:#|%|//)\s*")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
_BLANKS = re.compile(
    r'"[^"]*"|[^\s\[("]+(?:\s*(?:\[[^\]]*\]|\([^)]*\)))?'
)  # a unit in brackets belongs to the name before it


class _Layout(NamedTuple):
    """Encoding and separator of a text (None for blanks), and what its first lines say."""

    encoding: str
    separator: str | None
    head: Head


def read_text(path: Path, column: int | str | None = None, delimiter: str | None = None) -> Values:
    """Signal in a delimited text.

    Numbers have decimal points, or commas where these do not separate the columns. Lines before the numbers are a header, lines of
    text after them a note. The first column can hold times. ``column`` is a number, from 0, or a name in the header.

    Raises
    ------
    UnusableError
        If the file is not such a text, does not have the column, or has text or gaps among its numbers.
    """
    with guarded(path, "delimited text"):
        encoding = _encoding(path)
        with path.open(encoding=encoding, errors="replace") as text:
            lines = [line.rstrip("\r\n") for line in islice(text, _HEAD_LINES)]
        layout = _layout(lines, encoding, delimiter)
        head = layout.head
        if len(head.numbers) > len(lines):  # a channel on each line
            return table_signal(np.atleast_2d(_load(path, layout, head.numbers)).T, column)
        places = [n for n in columns_to_read(head, column) if n is not None]
        loaded = _load(path, layout, places)
        _check_finite(path, layout, loaded[:, -1])
        return signal_of(head, column, loaded[:, 0] if len(places) > 1 else None, loaded[:, -1].copy())


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


def _layout(lines: Sequence[str], encoding: str, delimiter: str | None) -> _Layout:
    """Separator and head: of the separators that occur, the one that leaves most numbers."""
    best: tuple[int, tuple[bool, ...]] = (0, ())
    separator = delimiter
    for mark in (delimiter,) if delimiter else ("\t", ";", ",", None):
        found = pattern_of(_fields(line, mark) for line in lines if mark is None or mark in line or delimiter)
        if found[0] > best[0]:
            best, separator = found, mark
    if not best[0]:
        message = f"has no line of numbers among its first {len(lines)}"
        raise UnusableError(message)
    rows = [_fields(line, separator) for line in lines]
    head = head_of(lines, rows, best[1])
    if separator == ",":
        _check_commas(lines[head.first :], rows[: head.first], len(best[1]))
    return _Layout(encoding, separator, head)


def _fields(line: str, separator: str | None) -> list[str]:
    content = _COMMENT.sub("", line)
    fields = _BLANKS.findall(content) if separator is None else content.split(separator)
    return [field.strip().strip('"').strip() for field in fields]


def _check_commas(lines: Sequence[str], header: Sequence[Sequence[str]], count: int) -> None:
    """Refuse decimal commas between commas: there are two fields for each name, or two in each line, some second one like 05."""
    lines = [line.strip() for line in lines if line.strip()]
    alone = all(map(_DECIMAL_COMMA.fullmatch, lines)) and any(re.search(r",0\d", line) for line in lines)
    if alone or any(2 * len(fields) == count > 2 and not any(map(is_number, fields)) for fields in header):
        raise UnusableError(
            "has numbers with decimal commas, and commas separate its columns too; save it with decimal points"
        )


class _Rows:
    """Rows of numbers of a text, with decimal points; ``number`` counts lines from 1, ``count`` rows."""

    def __init__(self, text: IO[str], layout: _Layout) -> None:
        self.text, self.layout = enumerate(text, 1), layout
        self.number = self.count = 0
        self.line = ""

    def __iter__(self) -> Iterator[str]:
        first, commas = self.layout.head.first, self.layout.separator != ","
        for number, line in self.text:
            if number > first and not line.isspace() and not _COMMENT.match(line):
                self.number, self.line, self.count = number, line, self.count + 1
                yield line.replace(",", ".") if commas else line

    def rest_has_numbers(self) -> bool:
        """Whether a later line is a row of numbers again."""
        head, separator = self.layout.head, self.layout.separator
        return any(numbers_in(_fields(line, separator)) == head.mask for _, line in self.text)


def _load(path: Path, layout: _Layout, places: Sequence[int], most: int | None = None) -> NDArray[np.float64]:
    """Columns of a text, shape (time, column); of at most so many rows."""
    with path.open(encoding=layout.encoding, errors="replace") as text:
        rows = _Rows(text, layout)
        try:
            return np.loadtxt(
                islice(rows, most), delimiter=layout.separator, usecols=places, ndmin=2, comments=None, quotechar='"'
            )
        except ValueError:
            where, line, before = rows.number, rows.line.strip(), rows.count - 1
            if rows.rest_has_numbers() or not before:
                message = f"has text or a gap among its numbers, in line {where} ({line[:60]!r}); correct the file, or cut it there"
                raise UnusableError(message) from None
    return _load(path, layout, places, before)


def _check_finite(path: Path, layout: _Layout, values: NDArray[np.float64]) -> None:
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        with path.open(encoding=layout.encoding, errors="replace") as text:
            rows = _Rows(text, layout)
            for _ in islice(rows, int(wrong[0]) + 1):
                pass
        message = f"has values that are not finite numbers, {wrong.size} of {values.size}, the first in line {rows.number}; export it again"
        raise UnusableError(message)
