"""An example of each class of a corpus as a picture, and all of them on one."""

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.figure import Figure

from features.table.class_features import COMBS, class_features
from features.table.indicators import Orders, feature_names, indicators
from gen.corpus import FAULT_NAMES
from gen.support.units import from_si
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import (
    STYLE,
    WIDTH,
    DrawnRecord,
    draw_envelope_spectrum,
    draw_waveform,
)
from raceway.reports.subject import can_be_drawn, shown_of

CANDIDATES = 15  # records of a class among which its example is chosen


def examples_of(corpus: xr.Dataset) -> dict[str, tuple[DrawnRecord | None, str]]:
    """Example of each class that the corpus contains, None if no record can be drawn, and its caption."""
    return {FAULT_NAMES[code]: _example(corpus, code) for code in np.unique(corpus["fault"].values)}


@rc_context(STYLE)
def draw_overview(corpus: xr.Dataset) -> Figure:
    """Waveform and squared envelope spectrum of an example of each class that the corpus contains, a row for each.

    Raises
    ------
    ValueError
        If no record can be drawn.
    """
    # a class may have no record that can be drawn
    drawn = [shown for shown, _ in examples_of(corpus).values() if shown is not None]
    if not drawn:
        raise ValueError("no record has a signal, a shaft rate and fault orders to draw.")
    figure = Figure(figsize=(1.6 * WIDTH, 1.9 * len(drawn)), layout="constrained")
    for (waveform, envelope), shown in zip(figure.subplots(len(drawn), 2, squeeze=False), drawn, strict=True):
        draw_waveform(waveform, shown)
        draw_envelope_spectrum(envelope, shown)
        waveform.set_title(shown.title, color=FAULT_COLOURS[shown.fault], fontweight="bold", parse_math=False)
        envelope.set_title("")
    return figure


def _example(corpus: xr.Dataset, code: int) -> tuple[DrawnRecord | None, str]:
    """Record whose level at the fault lines is the median over some records of the class, and its caption; None if none can be drawn."""
    of_class = np.flatnonzero(corpus["fault"].values == code)
    numbers = of_class[np.linspace(0, len(of_class) - 1, min(CANDIDATES, len(of_class))).astype(int)]
    several = corpus.sizes["channel"] > 1
    shown = {int(n): shown_of(corpus.isel(record=n), int(n), 0, named=several) for n in numbers}
    levels = {n: _line_level(record) for n, record in shown.items() if can_be_drawn(record)}
    if not levels:
        return None, "No record of this class has a signal, a shaft rate and fault orders to draw."
    number = sorted(levels, key=lambda n: levels[n])[len(levels) // 2]
    conditions = _conditions(corpus.isel(record=number))
    some = f"{len(levels)} of the " if len(levels) < len(of_class) else "the "
    told = f"the median of {some}{len(of_class)} records of its class by the level of the fault lines"
    return shown[number], f"{conditions}; {told}."


def _conditions(record: xr.Dataset) -> str:
    """Specimen, speed, load if known, and width of the spall if there is one."""
    facts = [
        f"Specimen {int(record['specimen'])} of rig {int(record['rig'])}",
        f"{from_si(float(record['shaft_rate']), 'rpm'):.0f} rpm",
    ]
    if np.isfinite(record["load"]):
        facts.append(f"{float(record['load']):.0f} N")
    if float(record["width"]) > 0:
        facts.append(f"fault {from_si(float(record['width']), 'mm'):.2g} mm wide")
    return ", ".join(facts)


def _line_level(shown: DrawnRecord) -> float:
    """Highest level among the features that tell the class, or among all combs for a class without such features.

    -inf if the record is too short to have features.
    """
    names = feature_names(("lines",))
    orders = Orders(*(order.reshape(1) for order in shown.orders))
    values, _ = indicators(shown.signal[None], shown.fs, np.array([shown.shaft_rate]), orders, ("lines",))
    columns = [names.index(name) for name in class_features(shown.fault) or COMBS.values()]
    return float(np.nan_to_num(values[0, columns], nan=-np.inf).max())
