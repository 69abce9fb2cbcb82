"""A table of texts, in a file or a sheet: a header, rows, and perhaps notes at the end.

``lines of fields -> header -> columns to load -> blocks of numbers -> signal``

A row begins with a number or a time stamp, a line of the header and a note with text. So the first row is data, and no later line is
taken for a header or for the end: text or a gap among the rows is refused.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, islice
from typing import NamedTuple

import numpy as np

from raceway.importing.columns import LEAST_LENGTH, Values, columns_to_load, is_even, signal_of, table_signal
from raceway.importing.files import FloatArray, UnusableError
from raceway.importing.header import header_of
from raceway.importing.numerals import Form, block_of, is_number, numbers_in, readings

START = 400  # lines that tell the columns
_HEADER_LINES = 200
_ROWS = 4096  # of a block
_MOST_NOTES = 20
_MONTH = "(?:jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]*"
_STAMP = re.compile(
    rf"(?=.*(?:\d[-/:]\d|\d\.\d+\.\d|{_MONTH}))(?:[-\d/.:, +tz]|{_MONTH}|[ap]m|(?:mon|tue|wed|thu|fri|sat|sun)[a-z]*)+|'[-+\d.,]+",
    re.ASCII | re.IGNORECASE,
)  # or a number that a sheet holds as text
_NO_VALUE = re.compile(
    r"[-+]?(?:nan|inf(?:inity)?|n/?a|null|none|true|false|bad|ov(?:l|r|f|er(?:flow|load|range)?)|err(?:or)?|-{1,3})|#(?:n/?a|nv|.*[!?])",
    re.IGNORECASE,
)
_DIGIT = re.compile(r"[-+.,]?\d")


class TableLine(NamedTuple):
    """A line of a table: its number from 1, and its fields without blanks around them."""

    number: int
    fields: list[str]


def is_value(field: str) -> bool:
    """Whether a field is a number or a time stamp.

    >>> [is_value(field) for field in ("0,5", "24.11.2026 10:00", "Nov 24, 2026", "0,5 0,7", "RMS")]
    [True, True, True, False, False]
    """
    return is_number(field) or _STAMP.fullmatch(field) is not None


def is_row(fields: Iterable[str]) -> bool:
    """Whether the first field that is not empty is a number or a time stamp, and one is a number.

    >>> is_row(["", "0.5", "started"]), is_row(["10:00:01", "0.5"]), is_row(["RMS", "0.5"]), is_row(["2026-11-24", ""])
    (True, True, False, False)
    """
    filled = [*filter(None, fields)]
    return bool(filled) and is_value(filled[0]) and any(map(is_number, filled))


def is_flawed_row(fields: Iterable[str]) -> bool:
    """Whether a line that is no row may be one with a value that is missing or marked.

    >>> is_flawed_row(["10:00:01", "OVL"]), is_flawed_row(["0.5*"]), is_flawed_row(["RMS", "OVL"])
    (True, True, False)
    """
    filled = [*filter(None, fields)]
    values = all(is_value(field) or _NO_VALUE.fullmatch(field) for field in filled)
    return bool(filled) and (
        values or _DIGIT.match(filled[0]) is not None or _NO_VALUE.fullmatch(filled[0]) is not None
    )


def read_table(
    lines: Iterator[TableLine], column: int | str | None, place: Callable[[int, int], str], form: Form | None = None
) -> Values:
    """Signal in a table.

    Parameters
    ----------
    lines
        All lines, empty ones too.
    column
        Number, from 0, or name.
    place
        Words on where a field is, by the number of its line and of its column.
    form
        How numbers are written; by default the only way that suits all of them.

    Raises
    ------
    UnusableError
        If there is no such column, or if it has text or gaps among its numbers, or numbers that can be read in two ways.
    """
    start = [*islice(lines, START)]
    first = next((n for n, line in enumerate(start[: _HEADER_LINES + 1]) if is_row(line.fields)), None)
    if first is None:
        message = f"has no row of numbers among its first {min(len(start), _HEADER_LINES)} lines; export a row of numbers for each sample"
        raise UnusableError(message)
    above = [line for line in start[:first] if any(line.fields)]
    rows = [line.fields for line in start[first:] if is_row(line.fields)]
    forms = [form] if form else None
    if len(start) == len(rows) and len(rows[0]) >= LEAST_LENGTH * len(rows):
        return table_signal(np.stack(_numbers([[block_of(fields) or ""] for fields in rows], forms)), column)
    filled = max(n for n, field in enumerate(rows[0], 1) if field)
    header = header_of([line.fields for line in above], filled, len(rows[0]))
    width = max(len(rows[0]), len(header.names))
    columns = [[fields[n] if n < len(fields) else "" for fields in rows] for n in range(width)]
    numeric = [n for n in range(width) if any(map(is_number, columns[n]))]
    last = above[-1].fields if above else []
    if last and (is_flawed_row(last) or all(n < len(last) and is_number(last[n]) for n in numeric)):
        message = f"has text among numbers in {place(above[-1].number, 0)}, where the rows begin; correct that line, or delete it"
        raise UnusableError(message)
    if any(not columns[n][0] and all(columns[n][1:]) for n in numeric):
        message = f"has a gap in {place(start[first].number, 0)}, where the rows begin; delete that line if it has no samples, or fill it"
        raise UnusableError(message)
    even = [n for n in numeric if _is_even(columns[n])]
    places = columns_to_load(header, column, numeric, even)
    least = max(
        max(places) + 1, *(len(fields) for fields in rows[1:2])
    )  # of fields; a gap between blanks would move the later ones
    blocks, notes = _load(chain(start[first:], lines), places, range(least, width + 1), place)
    loaded = dict(zip(places, _numbers(blocks, forms), strict=True))
    return signal_of(header, column, loaded)._replace(notes=notes)


def _is_even(fields: Sequence[str]) -> bool:
    block = block_of(fields)
    return block is not None and any(is_even(numbers_in([block], form)) for form in readings([block]))


def _numbers(columns: Sequence[Sequence[str]], forms: Sequence[Form] | None) -> list[FloatArray]:
    """Numbers of columns of blocks, which are all written in one form."""
    forms = readings([block for blocks in columns for block in blocks]) if forms is None else forms
    if len(forms) != 1:
        how = "that can be read in two ways, such as 1.234" if forms else "that are written in different ways"
        message = f"has numbers {how}; export them with decimal points, and without marks between thousands"
        raise UnusableError(message)
    return [numbers_in(blocks, forms[0]) for blocks in columns]


def _load(
    lines: Iterator[TableLine], places: Sequence[int], counts: range, place: Callable[[int, int], str]
) -> tuple[list[list[str]], tuple[str, ...]]:
    """Blocks of numbers of each column to be loaded, and a sentence on notes that are left out."""
    loaded: list[list[str]] = []
    while (some := [*islice(lines, _ROWS)]) and (blocks := _blocks(some, places, counts)):
        loaded.append(blocks)
    rest = chain(some, lines)
    end, notes = None, []
    for line in rest:
        blocks = _blocks([line], places, counts) if end is None else None
        if blocks:
            loaded.append(blocks)
            continue
        end = end or line
        notes += [" ".join(line.fields)] if any(line.fields) else []
        where, reason = _flaw(line, end, places, counts, place)
        if not reason and len(notes) > _MOST_NOTES:
            where, reason = end, f"has more than {_MOST_NOTES} lines of text from {place(end.number, 0)} on"
        if reason:
            lost = sum(is_row(one.fields) for one in chain([line], rest))
            text = " ".join(where.fields)
            message = f"{reason} ({text!r:.60}), where {lost} rows would be lost; correct the file, or cut it there"
            raise UnusableError(message)
    told = [f"text after the numbers is left out: {notes[0]!r:.60}, lines: {len(notes)}"] if notes else []
    return [*map(list, zip(*loaded, strict=True))], tuple(told)


def _blocks(lines: Sequence[TableLine], places: Sequence[int], counts: range) -> list[str] | None:
    """Numbers of each column in lines; None if not all of them are rows of as many fields with numbers in these columns."""
    if not {len(line.fields) for line in lines} <= {*counts}:
        return None
    if 0 not in places and not all(is_row(line.fields) for line in lines):
        return None
    blocks = [block_of([line.fields[n] for line in lines]) for n in places]
    return [block for block in blocks if block] if all(blocks) else None


def _flaw(
    line: TableLine, end: TableLine, places: Sequence[int], counts: range, place: Callable[[int, int], str]
) -> tuple[TableLine, str]:
    """Reason why a line after the ``end`` of the rows is no note, and the line to be named; no reason if it is one, or empty."""
    if is_row(line.fields) and end is not line:
        what = "text" if any(end.fields) else "an empty line"
        return end, f"has {what} among its rows in {place(end.number, 0)}"
    if is_row(line.fields) and len(line.fields) not in counts:
        return line, f"has not as many fields as the rows before in {place(line.number, 0)}"
    if is_row(line.fields) or is_flawed_row(line.fields):
        missing = (n for n in places if n >= len(line.fields) or not is_number(line.fields[n]))
        return line, f"has no number in {place(line.number, next(missing, 0))}"
    return line, ""
