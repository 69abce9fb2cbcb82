"""A synthetic corpus and real ones on one self-contained page: AUC, quantiles and pictures of each class.

``Comparison -> tables, an example of each class from each set, distributions`` into one HTML file, beside a JSON file
with all numbers. Names of folders are escaped by the page and not drawn.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from features.table.indicators import Orders
from gen.corpus import make_result_folder, write_numbers
from raceway.comparing.comparison import SHARES, Comparison, finite
from raceway.comparing.measures import MEASURES, NAMES
from raceway.comparing.windows import Windows, typical_window
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import DrawnRecord, picture
from raceway.reports.sides import draw_distributions, draw_sides
from raceway.reports.templates import write_page

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
    # names of the sets in pictures, which show no text of a corpus
    real = {windows.name: f"real {number}" for number, windows in enumerate(comparison.real, start=1)}
    letters = {comparison.synthetic.name: "synthetic"} | real
    classes = [_part(comparison, fault, letters) for fault in comparison.auc]
    make_result_folder(output)
    write_numbers(comparison.plain(), output / "comparison.json")
    return write_page(
        output / "report.html",
        "comparison.html.jinja",
        "raceway.comparing",
        comparison=comparison,
        measures=MEASURES,
        shares=[f"{100 * share:g} %" for share in SHARES],
        letters=letters,
        classes=classes,
        typical=TYPICAL,
    )


def _part(comparison: Comparison, fault: str, letters: Mapping[str, str]) -> dict[str, Any]:
    """Variables of the template about one class."""
    # sets without this class have no column
    sets = [windows for windows in (comparison.synthetic, *comparison.real) if windows.values_of(fault).size]
    measures = [measure for measure in MEASURES if measure.name in comparison.auc[fault]]
    values = {
        f"{measure.name} [{measure.unit}]": {
            letters[windows.name]: finite(windows.values_of(fault)[:, NAMES.index(measure.name)]) for windows in sets
        }
        for measure in measures
    }
    # in short windows no line stands out, so the measures of lines have no values
    drawn = {label: columns for label, columns in values.items() if any(column.size for column in columns.values())}
    numbers = {name: number for number, name in enumerate(letters)}
    shown = {numbers[w.name]: _shown(w, fault, letters[w.name], comparison) for w in sets}
    return {
        "fault": fault,
        "colour": FAULT_COLOURS[fault],
        "counts": [(windows.name, len(windows.values_of(fault))) for windows in sets],
        "measures": measures,
        "sides": picture(draw_sides(shown, comparison.common.top), "svg"),
        "distributions": picture(draw_distributions(drawn, list(letters.values())), "svg"),
    }


def _shown(windows: Windows, fault: str, title: str, comparison: Comparison) -> DrawnRecord:
    record, signal, operation = typical_window(windows, fault, TYPICAL, comparison.common)
    orders = Orders(*(np.asarray(operation[name]) for name in Orders._fields))
    return DrawnRecord(
        f"{title}, record {record}", signal, operation["sample_rate"], operation["shaft_rate"], orders, fault
    )
