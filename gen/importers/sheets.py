"""Sheets of Excel files, read with python-calamine, which is an extra."""

from pathlib import Path

import numpy as np

from gen.importers.columns import Values, columns_to_read, signal_of
from gen.importers.files import UnusableError, guarded
from gen.importers.header import head_of, pattern_of

_HEAD_ROWS = 200


def read_sheet(path: Path, sheet: str | None, column: int | str | None) -> Values:
    """Signal in a sheet of an Excel file, by default the first one; rows and columns as in :func:`~gen.importers.text.read_text`.

    Raises
    ------
    UnusableError
        If python-calamine is missing, the file is no such file, or it does not have the sheet or the column.
    """
    try:
        from python_calamine import CalamineWorkbook
    except ImportError:
        raise UnusableError(
            "is an Excel file, which needs python-calamine; install it with pip install raceway[excel]"
        ) from None
    with guarded(path, "spreadsheet"):
        with CalamineWorkbook.from_path(str(path)) as book:
            if sheet is not None and sheet not in book.sheet_names:
                message = f"holds the sheets {', '.join(book.sheet_names)}, not {sheet}; name one"
                raise UnusableError(message, "variable")
            rows = book.get_sheet_by_name(sheet or book.sheet_names[0]).to_python(skip_empty_area=False)
        top = [[str(cell).strip() for cell in row] for row in rows[:_HEAD_ROWS]]
        weight, mask = pattern_of(top)
        if not weight:
            message = f"has no row of numbers among its first {len(top)}; name another sheet"
            raise UnusableError(message, "variable")
        head = head_of([" ".join(row) for row in top], top, mask)
        places = [n for n in columns_to_read(head, column) if n is not None]
        kept = [[row[n] for n in places] for row in rows[head.first :]]
        while kept and not all(isinstance(cell, int | float) for cell in kept[-1]):  # empty rows and a note
            kept.pop()
        for number, row in enumerate(kept, start=head.first + 1):
            if not all(isinstance(cell, int | float) for cell in row):
                message = f"has text or a gap among its numbers, in row {number} ({row!r:.60}); correct the file"
                raise UnusableError(message)
        values = np.array(kept, dtype=np.float64)
        return signal_of(head, column, values[:, 0] if len(places) > 1 else None, values[:, -1].copy())
