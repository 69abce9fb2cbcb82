"""A synthetic corpus and real ones on one self-contained page: AUC, quantiles and pictures of each class.

``Comparison -> tables, an example of each class from each set, distributions`` into one HTML file, beside a JSON file
with all numbers. Names of folders are escaped by the page and not drawn.
"""

from pathlib import Path
from typing import Any

import numpy as np

from features.signal.rows import FloatArray
from features.table.indicators import Orders
from gen.corpus import FAULTS, make_result_folder, write_numbers, write_text_durably
from raceway.comparing.comparison import SHARES, Comparison
from raceway.comparing.measures import MEASURES, NAMES, Measure
from raceway.comparing.windows import Windows, typical_window
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import DrawnRecord, picture
from raceway.reports.sides import draw_distributions, draw_sides
from raceway.reports.templates import template, three_digits

TYPICAL = "kurtosis"  # an example has the median of this measure, which every class has


def write_comparison(comparison: Comparison, output: Path | str) -> Path:
    """Write ``report.html`` and ``comparison.json`` into a folder, which is created if it does not exist.

    Returns
    -------
    The path of the page.

    Raises
    ------
    CorpusError
        If a corpus has changed since it was measured, or the disk refuses.
    """
    output = Path(output)
    page = template("comparison.html.jinja", "raceway.comparing").render(
        comparison=comparison,
        measures=MEASURES,
        shares=[f"{100 * share:g} %" for share in SHARES],
        letters=_letters(comparison),
        yardsticks=list(comparison.yardstick),
        classes=[_part(comparison, fault) for fault in comparison.auc],
        typical=TYPICAL,
    )
    make_result_folder(output)
    write_numbers(comparison.plain(), output / "comparison.json")
    write_text_durably(page, output / "report.html")
    return output / "report.html"


def _letters(comparison: Comparison) -> dict[str, str]:
    """Name of each set in pictures, which show no text of a corpus: real 1, real 2, ..."""
    real = {windows.name: f"real {number}" for number, windows in enumerate(comparison.real, start=1)}
    return {comparison.synthetic.name: "synthetic"} | real


def _part(comparison: Comparison, fault: str) -> dict[str, Any]:
    """Variables of the template about one class."""
    letters = _letters(comparison)
    # sets without this class have no column
    sets = [windows for windows in (comparison.synthetic, *comparison.real) if _of_class(windows, fault).size]
    measures = [measure for measure in MEASURES if measure.name in comparison.auc[fault]]
    values = {
        f"{measure.name} [{measure.unit}]": {letters[w.name]: _column(w, fault, measure.name) for w in sets}
        for measure in measures
    }
    # in short windows no line stands out, so the measures of lines have no values
    drawn = {label: columns for label, columns in values.items() if any(column.size for column in columns.values())}
    numbers = {name: number for number, name in enumerate(letters)}
    shown = {numbers[w.name]: _shown(w, fault, letters[w.name], comparison) for w in sets}
    return {
        "fault": fault,
        "colour": FAULT_COLOURS[fault],
        "counts": [(windows.name, len(_of_class(windows, fault))) for windows in sets],
        "rows": [_row(comparison, fault, measure) for measure in measures],
        "sides": picture(draw_sides(shown, comparison.common.top), "svg"),
        "distributions": picture(draw_distributions(drawn, list(letters.values())), "svg"),
    }


def _of_class(windows: Windows, fault: str) -> np.ndarray:
    return np.flatnonzero(windows.fault == FAULTS.index(fault))


def _column(windows: Windows, fault: str, measure: str) -> FloatArray:
    values = windows.values[_of_class(windows, fault), NAMES.index(measure)]
    return values[np.isfinite(values)]


def _shown(windows: Windows, fault: str, title: str, comparison: Comparison) -> DrawnRecord:
    record, signal, known = typical_window(windows, fault, TYPICAL, comparison.common)
    orders = Orders(*(np.asarray(known[name]) for name in Orders._fields))
    return DrawnRecord(f"{title}, record {record}", signal, known["sample_rate"], known["shaft_rate"], orders, fault)


def _row(comparison: Comparison, fault: str, measure: Measure) -> tuple[Measure, str, list[str], list[str], list[str]]:
    """Measure, its AUC, that of each real set against the others, and its quantiles in the synthetic set and in the real ones."""
    quantiles = comparison.quantiles[fault][measure.name]
    held = [table.get(fault, {}).get(measure.name) for table in comparison.yardstick.values()]
    synthetic, real = (
        [three_digits(value) for value in quantiles.get(name, [])] for name in (comparison.synthetic.name, "real")
    )
    auc = _two_digits(comparison.auc[fault][measure.name])
    return measure, auc, [_two_digits(value) for value in held], synthetic, real


def _two_digits(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"
