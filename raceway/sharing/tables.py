"""Tables of labels and of their units, as CSV files that go with one file per record.

Programs for tables run a cell that begins with ``=``, ``+``, ``-`` or ``@`` as a formula. Texts of a corpus can come from strangers, so
such a text gets an apostrophe in front of it.
"""

import csv
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from gen.corpus.schema import DRAWS
from raceway.sharing.columns import Column, Export
from raceway.sharing.copying import Block

LABELS, VARIABLES = "labels.csv", "variables.csv"
_FORMULA = ("=", "+", "-", "@")


Writer = Callable[[Block, Iterable[str]], None]
"""Adds the rows of a block to a table; its second argument has the file of each record."""


@contextmanager
def label_table(export: Export, folder: Path) -> Iterator[Writer]:
    """Write ``labels.csv``, one row a record: its number in the corpus, its file, and its labels without its scenario."""
    columns = [column for column in export.columns if column.variable != DRAWS]
    with (folder / LABELS).open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["record", "file", *(column.name for column in columns)])

        def write(block: Block, files: Iterable[str]) -> None:
            cells = zip(*(map(_cell, column.of(block.dataset).tolist()) for column in columns), strict=True)
            for number, file, labels in zip(block.numbers.tolist(), files, cells, strict=True):
                table.writerow([number, file, *labels])

        yield write
    _write_variables(columns, folder)


def record_file(folder: Path, number: int) -> str:
    """Name of the file of a record, relative to the folder of the copy; a thousand records share one folder, which is made.

    >>> import tempfile
    >>> record_file(Path(tempfile.mkdtemp()), 12345)
    'records/00012/record-0012345.csv'
    """
    within = f"records/{number // 1000:05d}"
    (folder / within).mkdir(parents=True, exist_ok=True)
    return f"{within}/record-{number:07d}.csv"


def cell_text(text: str) -> str:
    """Text for one cell: no control characters, and no formula.

    >>> cell_text("6205"), cell_text("=1+1"), cell_text("a" + chr(10) + "b")
    ('6205', "'=1+1", 'a?b')
    """
    shown = "".join(letter if letter.isprintable() else "?" for letter in text)
    return f"'{shown}" if shown.lstrip().startswith(_FORMULA) else shown


def _cell(value: Any) -> Any:
    """Cell of a label; a number that is not known is empty."""
    if isinstance(value, str):
        return cell_text(value)
    return "" if isinstance(value, float) and np.isnan(value) else value


def _write_variables(columns: Sequence[Column], folder: Path) -> None:
    """Write ``variables.csv``: unit, role and meaning of each column of labels."""
    with (folder / VARIABLES).open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["name", "units", "role", "meaning", "values"])
        for column in columns:
            values = ", ".join(column.flags.values())
            table.writerow([column.name, *map(cell_text, (column.units, column.role, column.meaning, values))])
