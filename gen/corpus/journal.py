"""Rows of finished parts, and the journal ``parts.jsonl``: one such row per line while a corpus is unfinished.

The manifest is written when a corpus is begun and when it is complete. In between, the row of each finished part is appended to the
journal, which takes the same time for the first part and for the ten-thousandth. A part is on disk before its row is appended. A killed
process leaves at most one line without its end, which is ignored. The rows come from strangers as much as the manifest does, and are
checked in the same way.
"""

import json
import os
import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationError

from gen.corpus.files import plain_file
from gen.corpus.part import PartRow
from gen.corpus.signals import SignalCounts
from gen.errors import CorpusError
from gen.limits import check_limit

JOURNAL_NAME = "parts.jsonl"

FLUSHED_EVERY_S = 1.0
"""Longest time for which a row may be lost if the machine itself fails [s]; the loss costs nothing but making the part again."""

_PART_NAME = re.compile(r"part-(\d{5,9})\.nc")

Count = Annotated[int, Field(ge=0, lt=2**63)]
_Hash = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]


class Strict(BaseModel):
    """Checked value of the manifest: no conversion of types, and no change."""

    model_config = ConfigDict(strict=True, frozen=True, extra="allow")


class FileRow(Strict):
    """Size and SHA-256 of a file, as listed in the manifest."""

    bytes: Count
    sha256: _Hash


class _ListedSignals(Strict):
    clipped: Count
    dead: Count
    constant: Count
    not_finite: Count


class ListedPart(FileRow):
    """A part as listed in the manifest or in the journal."""

    name: str
    records: Count
    signals_: Annotated[_ListedSignals, Field(alias="signals")]

    @property
    def row(self) -> PartRow:
        """The same row as a tuple."""
        return PartRow(self.name, self.records, self.bytes, self.sha256, SignalCounts(**dict(self.signals_)))


def listed(row: PartRow) -> dict[str, Any]:
    """Row of a part as it is stored in JSON."""
    return row._asdict() | {"signals": row.signals._asdict()}


def name_problem(name: str) -> str | None:
    """Reason why a name cannot be that of a part; None if it can."""
    return None if _PART_NAME.fullmatch(name) else f"{name!r} is not the name of a part (part-00000.nc, ...)"


def part_number(name: str) -> int:
    """Number of a part.

    >>> part_number("part-00012.nc")
    12
    """
    return int(_PART_NAME.sub(r"\1", name))


@contextmanager
def new_journal(directory: Path) -> Iterator[Callable[[PartRow], None]]:
    """Function that appends the row of a finished part to a new journal.

    Raises
    ------
    CorpusError
        If the journal cannot be written, or if there is one already.
    """
    path = directory / JOURNAL_NAME
    with _reason_said(path):
        stream = path.open("xb")  # a new file: an old one could be a link to any file of this machine
    flushed = time.monotonic()

    def append(row: PartRow) -> None:
        nonlocal flushed
        with _reason_said(path):
            stream.write(json.dumps(listed(row)).encode() + b"\n")
            stream.flush()  # a killed process loses no row that has been flushed
            if time.monotonic() - flushed >= FLUSHED_EVERY_S:
                os.fsync(stream.fileno())
                flushed = time.monotonic()

    try:
        yield append
    finally:
        with _reason_said(path):
            stream.close()


@contextmanager
def _reason_said(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise CorpusError(
            f"{path}: could not be written ({error.strerror or error}); free some space or choose another folder."
        ) from error


def read_journal(directory: Path) -> list[ListedPart]:
    """Rows of the journal in the order in which they were written; none if there is no journal. A line without its end is left out.

    Raises
    ------
    CorpusError
        If the journal is not a plain file inside the folder, is too large, or has a line that is not the row of a part.
    """
    path = directory / JOURNAL_NAME
    if not path.exists():
        return []
    plain_file(directory, JOURNAL_NAME)
    try:
        check_limit("manifest_bytes", path.stat().st_size, f"{path}:", CorpusError)
        *lines, _ = path.read_bytes().split(b"\n")
    except OSError as error:
        raise CorpusError(f"{path}: cannot be read ({error.strerror or error}); copy the corpus again.") from None
    return [_checked(line, f"{path}: line {number}") for number, line in enumerate(lines, start=1)]


def _checked(line: bytes, place: str) -> ListedPart:
    try:
        found = ListedPart.model_validate_json(line)
    except ValidationError as error:
        raise _not_a_row(place, first_problem(error)) from None
    if (problem := name_problem(found.name)) is not None:
        raise _not_a_row(place, problem)
    return found


def _not_a_row(place: str, problem: str) -> CorpusError:
    return CorpusError(f"{place} is not the row of a part ({problem}); delete this file, and its parts are made again.")


def first_problem(error: ValidationError) -> str:
    """Place and reason of the first error."""
    item = error.errors(include_url=False, include_input=False)[0]
    place = ".".join(str(step) for step in item["loc"])
    reason = item["msg"][0].lower() + item["msg"][1:]
    return f"{place}: {reason}" if place else reason
