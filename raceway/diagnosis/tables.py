"""Diagnoses of a folder as a table: on the terminal, as the index of the pages, and as a CSV file."""

import csv
import io
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from raceway.console import show

INDEX, LIST = "index.html", "diagnoses.csv"
LIST_KIND = "list of diagnoses"
NOT_USED = "not used"
SHOWN_LINES = 2


class DiagnosisRow(NamedTuple):
    """One recording: of a file that cannot be used only the name and a sentence. The fields are the columns of the CSV file."""

    recording: str
    verdict: str
    likeliest: str = ""
    probability: float | None = None  # of the likeliest class
    rpm: float | None = None
    strongest_lines: str = ""
    warnings: int | None = None
    page: str = ""
    sentence: str = ""

    @property
    def chance(self) -> str:
        """Probability with two digits, and its class if it is not the verdict."""
        if self.probability is None:
            return ""
        return f"{'' if self.likeliest == self.verdict else f'{self.likeliest} '}{self.probability:.2f}"

    @property
    def speed(self) -> str:
        """Speed of the shaft without decimals."""
        return "" if self.rpm is None else f"{self.rpm:,.0f}"

    @property
    def link(self) -> str:
        """Relative address of the page."""
        return quote(os.fsencode(self.page))


def rows_of(answers: Sequence[Mapping[str, Any]], unusable: Mapping[Path, str]) -> list[DiagnosisRow]:
    """Rows of the facts of each diagnosis, then of the files that cannot be used, each with a sentence that tells no folder."""
    sentences = {path.name: path.name + sentence.removeprefix(str(path)) for path, sentence in unusable.items()}
    unused = [DiagnosisRow(name, NOT_USED, sentence=sentence) for name, sentence in sentences.items()]
    return [*map(_row, answers), *unused]


def _row(facts: Mapping[str, Any]) -> DiagnosisRow:
    likeliest = max(facts["probabilities"], key=facts["probabilities"].get)
    strongest = [f"{line['line']} {line['level_db']:.0f} dB" for line in facts["evidence"][:SHOWN_LINES]]
    return DiagnosisRow(
        recording=facts["recording"].name,
        verdict=facts["verdict"],
        likeliest=likeliest,
        probability=round(facts["probabilities"][likeliest], 4),
        rpm=round(facts["shaft_rpm"], 1),
        strongest_lines=", ".join(strongest),
        warnings=len(facts["warnings"]),
        page="" if facts["report"] is None else facts["report"].name,
        sentence=facts["sentence"],
    )


def show_table(rows: Sequence[DiagnosisRow]) -> None:
    """Print a line for each recording, and a sentence for each file that cannot be used."""
    header = ("recording", "verdict", "probability", "rpm", "strongest lines", "warnings")
    show.table(
        header,
        ((row.recording, row.verdict, row.chance, row.speed, row.strongest_lines, row.warnings or "") for row in rows),
    )
    if errors := [row.sentence for row in rows if row.verdict == NOT_USED]:
        show.text("", *errors)


def write_index(rows: Sequence[DiagnosisRow], name: str, pages: Path) -> None:
    """Write the index page and the CSV file of a folder of recordings beside the pages.

    Raises
    ------
    CorpusError
        If one of the two exists and was not made by Raceway, or the disk refuses it.
    """
    from gen.corpus import check_result, make_result_folder, write_text_durably
    from raceway.reports.class_colours import FAULT_COLOURS
    from raceway.reports.templates import write_page

    make_result_folder(pages)
    counts = Counter(row.verdict for row in rows)
    about = {"name": name, "rows": rows, "counts": counts, "colours": FAULT_COLOURS, "list": LIST}
    write_page(pages / INDEX, "diagnoses.html.jinja", "raceway.diagnosis", **about)
    # only a list of Raceway is replaced
    check_result(pages / LIST, LIST_KIND)
    write_text_durably(_csv_text(rows), pages / LIST)


def _csv_text(rows: Sequence[DiagnosisRow]) -> str:
    from gen.support.display import cell_text  # not at the top: help needs nothing of gen

    stream = io.StringIO()
    table = csv.writer(stream, lineterminator="\n")
    table.writerow(DiagnosisRow._fields)
    table.writerows([cell_text(value) if isinstance(value, str) else value for value in row] for row in rows)
    return stream.getvalue()
