"""Sheets of spreadsheets (.xlsx, .xls, .ods), read with python-calamine: ``size -> sheet -> lines of fields -> table``."""

import csv
import io
import os
import re
import struct
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from datetime import date, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.support.limits import check_limit
from raceway.importing.numerals import is_number
from raceway.importing.refused_files import UnusableError, guarded, optional
from raceway.importing.table import NumberTable, read_table

_CELL = re.compile(rb"r\s*=\s*[\"']([A-Za-z]{1,3})(\d{1,7})[\"']")
_ODS_TAG = re.compile(rb"<table:table-(row|cell)\b([^>]*)>")
_REPEATED = re.compile(rb"number-(?:row|column)s-repeated\s*=\s*[\"'](\d+)[\"']")
_CELL_BYTES = 32  # that the library takes for each cell of the rectangle around all cells
_MOST_ROWS = 1_048_576
_OLD_BYTES = 7_300_000  # of an old Excel file whose head lists all of its tables of sectors
_CHUNK = 4_000_000  # bytes
_OLD_SHAPE = (65_536, 256)  # rows and columns of an old Excel file
# records of an old Excel file: place of a sheet, its shape, and the end of a part
_PLACE, _SHAPE, _END = 0x85, 0x200, 0x0A
_MINI = 4096  # bytes; a shorter stream lies in sectors of 64 bytes, which are parts of the stream of the first entry


def read_sheet(path: Path, sheet: str | None) -> NumberTable:
    """Table in a sheet of a spreadsheet, by default the visible one that is active, or else the first visible one.

    Raises
    ------
    UnusableError
        If python-calamine is missing, the file is no such file or asks for too much memory, it does not have the sheet, or as in
        :func:`~raceway.importing.table.read_table`.
    """
    library = optional("python_calamine")
    with guarded(path, "spreadsheet"):
        active, output = 0, nullcontext()
        if zipfile.is_zipfile(path):
            active = _check_size(path)
        else:  # old Excel files have at most 65,536 rows of 256 columns
            _check_old_excel(path)
            output = _silent()
        with output, library.CalamineWorkbook.from_path(str(path)) as book:
            shown = library.SheetVisibleEnum.Visible, library.SheetTypeEnum.WorkSheet
            visible = [entry.name for entry in book.sheets_metadata if (entry.visible, entry.typ) == shown]
            name, notes = _chosen(book.sheet_names, visible, active, sheet)
            rows = book.get_sheet_by_name(name).to_python(skip_empty_area=False)
        text = io.StringIO()
        csv.writer(text, delimiter="\t", lineterminator="\n").writerows([_text(cell) for cell in row] for row in rows)
        table = read_table(text.getvalue().encode(), "\t", ".")
        return table._replace(notes=(*notes, *table.notes))


@contextmanager
def _silent() -> Iterator[None]:
    """No output on the standard error of the process, where a library in Rust writes of its panics for its developers."""
    stderr = os.dup(2)
    try:
        with Path(os.devnull).open("wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)


def _check_size(path: Path) -> int:
    """Number of the active sheet, after a check of the memory that cells take: one cell far away asks for a large rectangle."""
    with zipfile.ZipFile(path) as archive:
        check_limit("file_bytes", sum(part.file_size for part in archive.infolist()), "is unpacked", UnusableError)
        for part in archive.infolist():
            columns = rows = tags = cells = repeated = 0
            for block in _blocks(archive, part):
                for letters, row in _CELL.findall(block):
                    columns, rows = max(columns, _number(letters.upper())), max(rows, int(row))
                tags += block.count(b"<row")
                for kind, attributes in _ODS_TAG.findall(block):
                    times = int(count[1]) if (count := _REPEATED.search(attributes)) else 1
                    if kind == b"row":
                        repeated = times
                    elif b"office:value" in attributes:
                        cells += repeated * times
            if max(rows, tags) > _MOST_ROWS:
                raise UnusableError(
                    f"has a sheet of {max(rows, tags)} rows, and one of Excel has at most {_MOST_ROWS}; export it again"
                )
            what = f"has a sheet of {columns} columns and {rows} rows, which takes"
            check_limit("file_bytes", columns * rows * _CELL_BYTES, what, UnusableError)
            check_limit("file_bytes", cells * _CELL_BYTES, f"has a sheet of {cells} cells, which takes", UnusableError)
        if "xl/workbook.xml" not in archive.namelist():
            return 0
        tab = re.search(rb"\bactiveTab\s*=\s*[\"'](\d{1,5})[\"']", archive.read("xl/workbook.xml"))
        return int(tab[1]) if tab else 0


def _check_old_excel(path: Path) -> None:
    """Refuse an old Excel file with a ring of sectors or the shape of a larger sheet, for which the library takes memory until it ends.

    Source: Microsoft, [MS-CFB] of sectors and directories, and [MS-XLS] of records.
    """
    with path.open("rb") as stream:
        content = stream.read(_OLD_BYTES)
    if not content.startswith(b"\xd0\xcf\x11\xe0"):
        return
    size = 4096 if content[30] == 12 else 512
    head = np.frombuffer(content[:512].ljust(512, b"\0"), "<u4")
    counts, tables = head[[10, 11, 16, 18]], head[19:]
    following = np.concatenate(
        [
            np.frombuffer(content[(n + 1) * size : (n + 2) * size].ljust(size, b"\0"), "<u4")
            for n in tables[tables < len(content)].tolist()
        ]
    )
    # each sector leads to the one after it, and the last to an end, which leads to itself
    end = following.size
    place = np.append(np.minimum(following, end), end)
    for _ in range(end.bit_length()):
        place = place[place]
    if np.any(place < end) or counts.max() > len(content) // size or head[17] < len(content):
        raise UnusableError("is damaged, or an old Excel file above 6.8 MB; save it as .xlsx")
    sectors = content[size:]
    directory = _chain(sectors, following, int(head[12]), size)
    entries = [directory[start : start + 128] for start in range(0, len(directory), 128)]
    for entry in entries:
        if entry[:64].decode("utf-16le", "replace").partition("\0")[0] in ("Workbook", "Book"):
            start, length = struct.unpack_from("<II", entry, 116)
            if length >= _MINI:
                stream = _chain(sectors, following, start, size)
            else:
                whole = _chain(sectors, following, *struct.unpack_from("<I", entries[0], 116), size)
                shorter = np.frombuffer(_chain(sectors, following, int(head[15]), size), "<u4")
                stream = _chain(whole, shorter, start, 64)
            _check_shapes(stream)


def _chain(sectors: bytes, following: NDArray[np.uint32], start: int, size: int) -> bytes:
    """Content of the sectors from one on, each of which leads to the one after it, and the last to none."""
    parts: list[bytes] = []
    while start < following.size and len(parts) < following.size:
        parts.append(sectors[start * size :][:size])
        start = int(following[start])
    return b"".join(parts)


def _check_shapes(stream: bytes) -> None:
    """Refuse the stream of a workbook in which a sheet states a larger shape than an old Excel file can have."""
    for place in {int.from_bytes(content[:4], "little") for kind, content in _records(stream, 0) if kind == _PLACE}:
        for kind, content in _records(stream, place):
            if kind == _SHAPE and len(content) in (10, 14):
                first, last, _, columns = struct.unpack_from("<IIHH" if len(content) == 14 else "<4H", content)
                rows = (last - first) % 2**32 if last and columns else 0  # as the library counts them
                if rows > _OLD_SHAPE[0] or columns > _OLD_SHAPE[1]:
                    raise UnusableError(
                        f"has a sheet of {rows} rows and {columns} columns, more than an old Excel file can have; save it as .xlsx"
                    )


def _records(stream: bytes, place: int) -> Iterator[tuple[int, bytes]]:
    """Kind and content of each record from a place in the stream of a workbook on, up to the end of that part."""
    kind = 0
    while kind != _END and place + 4 <= len(stream):
        kind, length = struct.unpack_from("<HH", stream, place)
        yield kind, stream[place + 4 : place + 4 + length]
        place += 4 + length


def _blocks(archive: zipfile.ZipFile, part: zipfile.ZipInfo) -> Iterator[bytes]:
    """Content of a part in blocks that end with a tag."""
    rest = b""
    with archive.open(part) as stream:
        while block := stream.read(_CHUNK):
            whole, end, rest = (rest + block).rpartition(b">")
            yield whole + end
    yield rest


def _number(letters: bytes) -> int:
    """Number of the column with these letters, from 1."""
    number = 0
    for letter in letters:
        number = 26 * number + letter - ord("A") + 1
    return number


def _chosen(names: list[str], visible: list[str], active: int, wanted: str | None) -> tuple[str, tuple[str, ...]]:
    """Name of the sheet to be read, and a sentence if it was chosen of several."""
    if wanted is not None and wanted in names:
        return wanted, ()
    if wanted is not None or not visible:
        what = f"not {wanted}" if wanted is not None else "none of which is visible"
        raise UnusableError(f"holds the sheets {', '.join(names)}, {what}; name one", "variable")
    name = names[active] if active < len(names) and names[active] in visible else visible[0]
    others = [other for other in visible if other != name]
    return name, (f"sheet {name} is read, and not {', '.join(others)}",) if others else ()


def _text(cell: Any) -> str:
    """Text of a cell; a number that is stored as text begins with an apostrophe, as it does when it is typed."""
    if isinstance(cell, bool):
        return str(cell)
    if isinstance(cell, int | float):
        return repr(cell)
    if isinstance(cell, datetime | date):
        return cell.isoformat(" ") if isinstance(cell, datetime) else cell.isoformat()
    text = " ".join(str(cell).split())
    return f"'{text}" if is_number(text) else text
