"""A table of numbers in a text or a sheet: a header, rows, and perhaps notes at the end.

``first lines -> header, dialect -> all rows by pandas -> columns of numbers``

A row begins with a number or a time stamp, a line of the header and a note with text. So the first row is data, and no later line is
taken for a header or for the end: text or a gap among the rows is refused. The dialect is the mark between columns and the decimal one.
"""

import io
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from raceway.importing.header import Header, header_of
from raceway.importing.numerals import AS_PYTHON, PATTERNS, decimal_marks, is_number
from raceway.importing.refused_files import FloatArray, UnusableError, guarded
from raceway.importing.text_files import BLANK, first_lines, is_value, mark_between, split, text_of

_MOST_COLUMNS, _AXES = 64, 3  # of a table without names; beyond three axes of a sensor they may be windows
_LEAST_LENGTH, _LEAST_OF_CHANNELS = 8, 100  # of the longer axis, which is time, in widths of the shorter one
_HEADER_LINES = 200
_MOST_NOTES = 20
_NO_VALUE = re.compile(
    r"[-+]?(?:nan|inf(?:inity)?|n/?a|null|none|true|false|bad|ov(?:l|r|f|er(?:flow|load|range)?)|err(?:or)?|-{1,3})|#(?:n/?a|nv|.*[!?])",
    re.IGNORECASE,
)
_DIGIT = re.compile(r"[-+.,]?\d")


class NumberTable(NamedTuple):
    """Columns that begin with numbers, by their number from 0, each up to its first flaw.

    ``flaws`` are reasons why columns cannot be used; ``marks`` are the decimal marks with which columns that have such marks can be read;
    ``notes`` are sentences without their end. ``playback`` is a sample rate [Hz] in whose place another can be given; ``absolute`` is
    False for shares of the full scale of a converter; ``rpm`` is the speed of the shaft that the file states. ``variable`` is the name of
    the variable of a MATLAB file.
    """

    columns: Mapping[int, FloatArray]
    header: Header = Header()
    flaws: Mapping[int, UnusableError] = {}
    marks: Mapping[int, str] = {}
    notes: tuple[str, ...] = ()
    playback: float | None = None
    absolute: bool = True
    rpm: float | None = None
    variable: str = ""

    def without(self, column: int) -> "NumberTable":
        """Table without a column."""
        return self._replace(columns={n: values for n, values in self.columns.items() if n != column})


def read_text(path: Path, mark: str | None = None, decimal: str | None = None) -> NumberTable:
    """Table in a text, with a ``mark`` between its columns and a ``decimal`` mark, which are by default those that suit its first lines.

    Raises
    ------
    UnusableError
        If the file is no text with columns, or does not say which mark is between them, or as in :func:`read_table`.
    """
    content = text_of(path)
    with guarded(path, "delimited text"):
        return read_table(content, mark or mark_between(first_lines(content)), decimal)


def table_of(values: NDArray[Any]) -> NumberTable:
    """Table without names, whose longer axis is time.

    Raises
    ------
    UnusableError
        If the values are not real numbers, or not a table of which one axis is plainly that of time.
    """
    shorter, longer = (1, values.size) if values.ndim == 1 else sorted(values.shape) if values.ndim == 2 else (0, 0)
    least = _LEAST_LENGTH if shorter <= _AXES else _LEAST_OF_CHANNELS
    plain = shorter == 1 or (0 < shorter <= _MOST_COLUMNS and longer >= least * shorter)
    if values.dtype.kind not in "iuf" or values.size == 0 or not plain:
        what = "not one column of real numbers, or a few long ones; windows cannot be told from channels"
        raise UnusableError(f"holds {values.dtype} of shape {values.shape}, {what}")
    columns = np.atleast_2d(values).astype(np.float64, copy=False)
    return NumberTable(dict(enumerate(columns if len(columns) == shorter else columns.T)))


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


class _Text(NamedTuple):
    """A table in UTF-8 with a mark between its columns."""

    content: bytes
    mark: str

    @property
    def height(self) -> int:
        """Number of lines."""
        return self.content.count(b"\n")

    def flaw(self, number: int, first: int) -> UnusableError:
        """Reason why the line with a number from 1 cannot be used; the first row of numbers is in a line, too."""
        text = " ".join(next(split([self.content.split(b"\n", number)[number - 1].decode()], self.mark)).fields)
        where = f"line {number} ({text!r:.60}), where {self.height - number + 1} lines would be lost"
        # nothing is left of a file that is cut before its second row
        advice = "correct the file, or cut it there" if number > first else "correct that line"
        return UnusableError(f"has no row like the others in {where}; {advice}")

    def without_notes(self) -> "tuple[_Text, tuple[str, ...]]":
        """Text without the notes and empty lines at its end, and a sentence on them."""
        end, notes = len(self.content), list[str]()
        while end:
            line = self.content.rfind(b"\n", 0, end - 1) + 1
            fields = next(split([self.content[line:end].decode()], self.mark)).fields
            if is_row(fields) or is_flawed_row(fields):
                break
            notes += [" ".join(fields)] if any(fields) else []
            end = line
        text = self._replace(content=self.content[:end])
        if len(notes) > _MOST_NOTES:
            raise UnusableError(
                f"has more than {_MOST_NOTES} lines of text from line {text.height + 1} on; correct the file, or cut it there"
            )
        return text, (f"text after the numbers is left out: {notes[-1]!r:.60}, lines: {len(notes)}",) if notes else ()

    def parsed(self, start: int, width: int, point: str) -> pd.DataFrame:
        """Columns of numbers from a line on, and of texts where not all rows have plain numbers."""
        try:
            return pd.read_csv(
                io.BytesIO(self.content.split(b"\n", start - 1)[-1]), sep=r"\s+" if self.mark == BLANK else self.mark, decimal=point,
                header=None, names=range(width), skipinitialspace=True, skip_blank_lines=False, na_filter=False, low_memory=False,
                float_precision="round_trip",
            )  # fmt: skip
        except pd.errors.ParserError as error:
            line = re.search(r"in line (\d+)", str(error))
            if line is None:
                raise
            raise self.flaw(start + int(line[1]) - 1, start) from None


def read_table(content: bytes, mark: str, decimal: str | None) -> NumberTable:
    """Columns of a table in UTF-8 with a ``mark`` between them; ``decimal`` is by default the mark that suits its first lines.

    Raises
    ------
    UnusableError
        If it has no row of numbers, or text or a gap in place of one.
    """
    lines = [*split(first_lines(content), mark)]
    first = next((n for n, line in enumerate(lines[: _HEADER_LINES + 1]) if is_row(line.fields)), None)
    if first is None:
        raise UnusableError(
            f"has no row of numbers among its first {min(len(lines), _HEADER_LINES)} lines; export a row of numbers for each sample"
        )
    # the lines above the first row are its header, and those below the last one notes
    above = [line for line in lines[:first] if any(line.fields)]
    rows = [line.fields for line in lines[first:] if is_row(line.fields)]
    start, (text, notes) = lines[first].number, _Text(content, mark).without_notes()
    height = text.height - start + 1
    if height == len(rows) and len(rows[0]) >= _LEAST_LENGTH * len(rows):  # a signal in each row
        turned = "".join("\t".join(column) + "\n" for column in zip(*rows, strict=True))
        return read_table(turned.encode(), "\t", decimal)
    least = max(n for n, field in enumerate(rows[0], 1) if field)
    header = header_of([line.fields for line in above], least, len(rows[0]))
    width = max(len(header.names), *map(len, rows))
    header = header.widened(width)
    columns = [[fields[n] if n < len(fields) else "" for fields in rows] for n in range(width)]
    starts = {n: [*filter(is_number, fields)] for n, fields in enumerate(columns) if any(map(is_number, fields))}
    # a row must not be taken for the end of the header, nor a line of the header for the first row
    last = above[-1].fields if above else []
    if last and (is_flawed_row(last) or all(n < len(last) and is_number(last[n]) for n in starts)):
        raise text.flaw(above[-1].number, start)
    if any(not columns[n][0] and all(columns[n][1:]) for n in starts):
        raise text.flaw(start, start)
    if [*filter(None, rows[0])] == [str(height - 1)]:
        raise UnusableError(
            f"has {rows[0][0]} in line {start}, which is the number of the rows below; delete that line"
        )
    if 0 < header.samples < height:
        raise UnusableError(
            f"has {height} rows and states {header.samples} samples: it holds several blocks; save each in a file of its own"
        )
    # one column whose numbers have one reading tells the decimal mark of all
    marks = {n: decimal_marks(numbers) for n, numbers in starts.items() if re.search("[.,]", "".join(numbers))}
    point = decimal or ("," if "," in marks.values() and "." not in marks.values() else ".")
    frame = text.parsed(start, width, point)
    read = {n: _numbers(frame[n], point) for n in starts}
    # text begins a row, or between blanks moves the fields after it
    tested = frame if mark == BLANK else frame[[0]]
    row = min((_first_text(column, read.get(n), mark == BLANK) for n, column in tested.items()), default=height)  # type: ignore[arg-type]
    if row < height:
        raise text.flaw(start + row, start)
    # a column is used up to the first row in which it holds no number, and refused if it is asked for
    wrong = {n: int(np.argmin(np.isfinite(values))) for n, values in read.items() if not np.isfinite(values).all()}
    flaws = {n: text.flaw(start + row, start) for n, row in wrong.items()}
    cut = {n: values[: wrong.get(n)] for n, values in read.items()}
    return NumberTable(cut, header, flaws, {} if decimal else marks, notes)


def _first_text(column: "pd.Series[Any]", numbers: FloatArray | None, gaps: bool) -> int:
    """First row of a column that holds neither a number nor a time stamp; with ``gaps`` also one that is empty."""
    rows = [*range(len(column))] if numbers is None else np.flatnonzero(~np.isfinite(numbers)).tolist()
    texts = zip(rows, column.iloc[rows].astype(str).str.strip(), strict=True)
    return next((row for row, text in texts if (text or gaps) and not is_value(text)), len(column))


def _numbers(column: "pd.Series[Any]", point: str) -> FloatArray:
    """Numbers of a column, which may have marks between thousands or exponents of Fortran; NaN for what is none."""
    if column.dtype.kind in "iuf":
        return column.to_numpy(np.float64)
    texts = column.astype(str).str.strip()
    fitting = max((texts.str.fullmatch(form, flags=re.ASCII) for form in PATTERNS[point]), key=np.count_nonzero)
    return texts.where(fitting, "nan").str.translate(AS_PYTHON[point]).to_numpy(np.float64)
