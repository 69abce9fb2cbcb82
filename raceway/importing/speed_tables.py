"""Table of the speeds of the recordings in a folder, with the columns ``file`` and ``rpm`` and a row for each file."""

import re
from collections.abc import Iterable
from pathlib import Path

from gen.support.display import first_few
from gen.support.errors import CorpusError
from raceway.importing.label_tables import lines_of
from raceway.importing.numerals import IN_THOUSANDS, in_doubt
from raceway.importing.reading_options import Speeds, speeds_in

FILE, RPM = "file", "rpm"
_LONGEST_LINE = 1000  # characters that are read of a file that may be a recording


def is_speed_table(path: Path) -> bool:
    """Whether the first line of a file names the columns ``file`` and ``rpm``, as no recording does."""
    with path.open(encoding="utf-8-sig", errors="ignore") as stream:
        names = re.split("[\t;,]", stream.readline(_LONGEST_LINE))
    return {FILE, RPM} <= {name.strip(' "\n') for name in names}


def read_speed_table(table: Path, recordings: Iterable[Path], others: Iterable[Path]) -> dict[str, Speeds]:
    """Lowest and highest speed of each recording of a folder, by the name of its file; other columns are left out.

    ``others`` are files that may have a row and need none.

    Raises
    ------
    CorpusError
        If the file is no such table, has a speed that is none, a row without a file or a file twice, or a recording has no row.
    """
    (first, names), *lines = lines_of(table, f"{FILE} and {RPM}")
    if not {FILE, RPM} <= {*names}:
        raise CorpusError(f"{table}, row {first}: has the columns {', '.join(names)}; name one {FILE} and one {RPM}.")
    needed = [path.name for path in recordings]
    allowed = {*needed, *(path.name for path in others)}
    speeds: dict[str, Speeds] = {}
    rows = [(number, dict(zip(names, cells, strict=False))) for number, cells in lines]
    doubtful = in_doubt(speed for _, row in rows for speed in row.get(RPM, "").split("-"))
    for number, row in rows:
        name, text = row.get(FILE, ""), row.get(RPM, "")
        if name in speeds or name not in allowed:
            flaw = "is in two rows; remove one" if name in speeds else "is no recording of the folder; correct the name"
            raise CorpusError(f"{table}, row {number}, column {FILE}: {name!r:.60} {flaw}.")
        if doubtful and in_doubt(text.split("-")):
            raise CorpusError(f"{table}, row {number}, column {RPM}: {text} {IN_THOUSANDS}.")
        try:
            speeds[name] = speeds_in(text)
        except ValueError as error:
            raise CorpusError(f"{table}, row {number}, column {RPM}: {error}.") from None
    if missing := [name for name in needed if name not in speeds]:
        raise CorpusError(f"{table}: has no row for {first_few(missing, 1)}; add one for each recording of the folder.")
    return speeds
