"""Texts of the user: ``encoding -> lines -> mark between columns -> fields``."""

import codecs
import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from raceway.importing.numerals import is_number
from raceway.importing.refused_files import UnusableError, guarded

START = 400  # lines that tell the columns
BLANK = " "  # stands for any number of blanks and tabs
_BEGINNING = 2_000_000  # bytes
_LONGEST_LINE = 50_000_000  # bytes
_MARKS = ("\t", ";", ",", BLANK)
_BLANKS = re.compile(r"[ \t]+")
_EASTERN = re.compile(rb"[\x80-\xff]{3}")  # two letters with accents may stand side by side, but not three
_EASTERN_ENCODINGS = ("gb2312", "big5", "cp932", "cp949", "gb18030")
_MONTH = "(?:jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]*"
STAMP = re.compile(
    rf"(?=.*(?:\d[-/:]\d|\d\.\d+\.\d|{_MONTH}))(?:[-\d/.:, +tz]|{_MONTH}|[ap]m|(?:mon|tue|wed|thu|fri|sat|sun)[a-z]*)+|'[-+\d.,eE]+",
    re.ASCII | re.IGNORECASE,
)
"""A time stamp, or a number that a sheet holds as text."""


class TextLine(NamedTuple):
    """A line of a table: its number from 1, and its fields without blanks around them."""

    number: int
    fields: list[str]


def is_value(field: str) -> bool:
    """Whether a field is a number or a time stamp.

    >>> [is_value(field) for field in ("0,5", "24.11.2026 10:00", "Nov 24, 2026", "0,5 0,7", "RMS")]
    [True, True, True, False, False]
    """
    return is_number(field) or STAMP.fullmatch(field) is not None


def text_of(path: Path) -> bytes:
    r"""Text in UTF-8 with ``\n`` after each line.

    UTF-16 has a mark; other texts are in UTF-8, or with three bytes of other letters in a row in an encoding of East Asia, or in Latin-1.

    Raises
    ------
    UnusableError
        If the file is empty or too large, or holds zero bytes.
    """
    with guarded(path, "text"), path.open("rb") as stream:
        start = stream.read(_BEGINNING)
        wide = start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        content = start if b"\0" in start and not wide else start + stream.read()
        if wide:
            content = content.decode("utf-16", "replace").encode()
        if b"\0" in content:
            raise UnusableError("is no text with columns: it holds zero bytes; export it again")
        if not content.isascii():
            content = _decoded(content).encode()
        return content.replace(b"\r\n", b"\n").replace(b"\r", b"\n").rstrip(b"\n") + b"\n"


def _decoded(content: bytes) -> str:
    for encoding in ("utf-8-sig", *(_EASTERN_ENCODINGS if _EASTERN.search(content) else ())):
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    return content.decode("latin-1")


def first_lines(content: bytes) -> list[str]:
    """Lines that tell the columns, with their ends.

    Raises
    ------
    UnusableError
        If one is longer than a row can be.
    """
    *lines, rest = content.split(b"\n", START)
    lines += [rest] if rest and len(lines) < START else []
    if max(map(len, lines), default=0) > _LONGEST_LINE:
        raise UnusableError("is no text with columns: it holds a line without an end; export it again")
    return [f"{line.decode()}\n" for line in lines]


def split(lines: Iterable[str], mark: str) -> Iterator[TextLine]:
    """Fields of lines; a field in quotes can hold marks, and in a header line breaks."""
    reader = csv.reader((_BLANKS.sub(" ", line.strip()) for line in lines) if mark == BLANK else lines, delimiter=mark)
    number = 1
    for fields in reader:
        plain = [" ".join(field.split()) if "\n" in field else field.strip() for field in fields]
        yield TextLine(number, _with_units(plain) if mark == BLANK else plain)
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


def mark_between(lines: Sequence[str]) -> str:
    """Mark between the columns: the one with which most lines are rows of numbers.

    Raises
    ------
    UnusableError
        If there is no such line, or if commas may part the columns or be decimal ones.
    """
    rows = {mark: [line.fields for line in split(lines, mark) if _is_plain_row(line.fields)] for mark in _MARKS}
    most = max(map(len, rows.values()))
    if not most:
        raise UnusableError(
            f"has no row of numbers among its first {len(lines)} lines; export numbers, or give the mark between columns",
            "delimiter",
        )
    best = [mark for mark in _MARKS if len(rows[mark]) == most]
    numbers = {mark: [[*filter(is_number, fields)] for fields in rows[mark]] for mark in best}
    mark = next((mark for mark in best if max(map(len, rows[mark])) > 1), best[0])
    # 0,5 may be one number or two, and 512,37 too, where no number has a point
    written = "".join(number for row in numbers[mark] for number in row)
    whole = mark == "," and "." not in written and "," not in written
    if whole or any(numbers[other] != numbers[mark] for other in best):
        raise UnusableError(
            "has commas or blanks between digits, which may stand between columns or in numbers; give the mark between columns",
            "delimiter",
        )
    return mark


def _is_plain_row(fields: Sequence[str]) -> bool:
    return any(map(is_number, fields)) and all(not field or is_value(field) for field in fields)
