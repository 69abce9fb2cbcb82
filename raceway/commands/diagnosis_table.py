"""Table of the diagnoses of a folder of recordings."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from raceway.console import show

if TYPE_CHECKING:
    from features.diagnosis import Diagnosis

_SHOWN_LINES = 2


def recordings_in(folder: Path, without: Iterable[Path]) -> list[Path]:
    """Files of recordings in a folder, not below it, except some files.

    Raises
    ------
    CorpusError
        If there is none.
    """
    from gen.importers.signals import SUFFIXES
    from gen.support.errors import CorpusError

    left_out = {path.resolve() for path in without}
    files = (path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    found = sorted(path for path in files if path.suffix.lower() in SUFFIXES and path.resolve() not in left_out)
    if not found:
        message = f"{folder}: has no recording in it ({', '.join(SUFFIXES)}); give a recording, or the folder that holds them."
        raise CorpusError(message)
    return found


def show_table(diagnoses: Mapping[Path, "Diagnosis"], unusable: Mapping[Path, str]) -> None:
    """Print a row for each recording, and a sentence for each file that cannot be used."""
    header = ("recording", "verdict", "probability", "rpm", "strongest lines", "warnings")
    rows = [(path.name, *_row(diagnosis)) for path, diagnosis in diagnoses.items()]
    show.table(header, [*rows, *((path.name, "not used", "", "", "", "") for path in unusable)])
    if unusable:
        show.text("", *unusable.values())


def _row(diagnosis: "Diagnosis") -> tuple[object, ...]:
    lines = ", ".join(f"{line.name} {line.level:.0f} dB" for line in diagnosis.evidence[:_SHOWN_LINES])
    likeliest = max(diagnosis.probabilities, key=lambda fault: diagnosis.probabilities[fault])
    probability = f"{diagnosis.probabilities[likeliest]:.2f}"
    if likeliest != diagnosis.verdict:
        probability = f"{likeliest} {probability}"
    rpm = f"{60 * diagnosis.shaft_rate:,.0f}"
    return diagnosis.verdict, probability, rpm, lines, len(diagnosis.warnings) or ""
