"""Tables in text: ``encoding -> mark between columns -> lines of fields -> table``."""

import codecs
import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import IO

from raceway.importing.columns import Values
from raceway.importing.files import UnusableError, guarded
from raceway.importing.numerals import is_number
from raceway.importing.table import START, TableLine, is_value, read_table

_BEGINNING = 2_000_000  # bytes that tell the encoding
_LONGEST_LINE = 50_000_000  # letters
_ONE_COLUMN = "\x1f"
_MARKS = ("\t", ";", ",", " ")
_BLANKS = re.compile(r"[ \t]+")


def read_text(path: Path, column: int | str | None = None, delimiter: str | None = None) -> Values:
    """Signal in a text with columns; ``delimiter`` is the mark between them, a blank stands for any number of blanks.

    Raises
    ------
    UnusableError
        If the file is not such a text, does not say which mark is between its columns, or as in
        :func:`~raceway.importing.table.read_table`.
    """
    with guarded(path, "delimited text"):
        encoding = encoding_of(path)
        with path.open(encoding=encoding, errors="replace") as text:
            mark = delimiter or _mark([*islice(lines_of(text), START)])
        with path.open(encoding=encoding, errors="replace") as text:
            return read_table(_split(lines_of(text), mark), column, lambda number, _: f"line {number}")


def encoding_of(path: Path) -> str:
    """Encoding of a text by its beginning: UTF-16 has a mark, and what is no UTF-8 is read as Latin-1."""
    with path.open("rb") as stream:
        start = stream.read(_BEGINNING)
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    try:
        codecs.getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def lines_of(text: IO[str]) -> Iterator[str]:
    """Lines of a text, none of which is longer than a row can be."""
    while line := text.readline(_LONGEST_LINE):
        if len(line) == _LONGEST_LINE or "\0" in line:
            raise UnusableError(
                "is no text with columns: it holds zero bytes, or a line without an end; export it again"
            )
        yield line


def _split(lines: Iterable[str], mark: str) -> Iterator[TableLine]:
    """Fields of lines; a field in quotes can hold marks, and in a header line breaks."""
    reader = csv.reader((_BLANKS.sub(" ", line.strip()) for line in lines) if mark == " " else lines, delimiter=mark)
    number = 1
    for fields in reader:
        plain = [field.strip() for field in fields]
        if reader.line_num > number:
            plain = [" ".join(field.split()) for field in plain]
        yield TableLine(number, _with_units(plain) if mark == " " else plain)
        number = reader.line_num + 1


def _with_units(fields: Sequence[str]) -> list[str]:
    """Fields between blanks, a unit in brackets with the name before it."""
    joined: list[str] = []
    for field in fields:
        if field[:1] in ("[", "(") and joined:
            joined[-1] += f" {field}"
        else:
            joined.append(field)
    return joined


def _mark(lines: Sequence[str]) -> str:
    """Mark between the columns: the one with which most lines are rows of numbers.

    Raises
    ------
    UnusableError
        If there is no such line, or if commas may part the columns or be decimal ones.
    """
    rows = {mark: [line.fields for line in _split(lines, mark) if _is_plain_row(line.fields)] for mark in _MARKS}
    most = max(map(len, rows.values()))
    if not most:
        message = f"has no row of numbers among its first {len(lines)} lines; export numbers, or give the mark between columns"
        raise UnusableError(message, "delimiter")
    best = [mark for mark in _MARKS if len(rows[mark]) == most]
    parting = [mark for mark in best if any(sum(map(bool, fields)) > 1 for fields in rows[mark])]
    if not parting:  # but there may be empty fields
        return next((mark for mark in best if any(len(fields) > 1 for fields in rows[mark])), _ONE_COLUMN)
    whole = not any(set(field) & {".", ","} for fields in rows[parting[0]] for field in fields if is_number(field))
    if len(parting) < len(best) or (parting[0] == "," and whole):  # 0,5 may be one number or two
        message = "has commas or blanks between digits, which may stand between columns or in numbers; give the mark between columns"
        raise UnusableError(message, "delimiter")
    return parting[0]


def _is_plain_row(fields: Sequence[str]) -> bool:
    return any(map(is_number, fields)) and all(not field or is_value(field) for field in fields)
