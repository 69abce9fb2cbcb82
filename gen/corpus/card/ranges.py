"""Least, median and largest value of each per-record quantity by class, for the data card of a corpus."""

import numpy as np
import pandas as pd
import xarray as xr

from gen.corpus.card.markdown import plain_text, table
from gen.corpus.choice import per_record
from gen.corpus.schema import FAULT_NAMES

_MEANING = "Least / median / largest known value of the records of each class, in the stored unit; one value if all are the same."


def ranges(corpus: xr.Dataset) -> list[str]:
    """Section with a table of the quantities that vary, and the value of each that does not."""
    values = _quantities(corpus)
    vary = values.nunique() > 1
    fault = corpus["fault"].values
    by_class = values.groupby(fault)
    classes = [FAULT_NAMES.get(code, str(code)) for code in np.unique(fault).tolist()]
    rows: list[tuple[str, ...]] = []
    for name in values.columns[vary]:
        extents = by_class[name].agg(["min", "median", "max"]).to_numpy().tolist()
        rows.append((_shown(name), _unit(corpus[name].variable), *map(_extent, extents)))
    lines = ["", "## Ranges", "", _MEANING, *table(("variable", "unit", *classes), rows, right=len(classes))]
    first = values.loc[:, ~vary].max()  # of equal values, some of which are not known
    same = [
        f"{_shown(name)} {value:.6g} {_unit(corpus[name].variable)}".removesuffix(" 1")
        for name, value in first.items()
        if value
    ]
    return [*lines, "", f"The same in all records: {', '.join(same)}."] if same else lines


def _quantities(corpus: xr.Dataset) -> pd.DataFrame:
    """Numbers of the records that are neither classes nor provenance, a row a record; NaN where one is not known."""
    chosen = {
        name: variable[:].values.astype(float)  # of a copy, because the corpus would keep the values in memory
        for name in per_record(corpus)
        if (variable := corpus[name].variable).dtype.kind in "fiu"
        and variable.attrs.get("role") != "provenance"
        and "flag_values" not in variable.attrs
    }
    frame = pd.DataFrame(chosen).replace([np.inf, -np.inf], np.nan)
    return frame.dropna(axis="columns", how="all")


def _shown(name: object) -> str:
    return f"`{plain_text(name)}`"


def _unit(variable: xr.Variable) -> str:
    """Unit in a table; that of a level in decibels is stored as 1, because CF has no unit for it."""
    in_decibels = "decibels" in str(variable.attrs.get("long_name"))
    return "dB" if in_decibels else plain_text(variable.attrs.get("units", ""))


def _extent(values: list[float]) -> str:
    """Cell of a class, of its least, median and largest value."""
    if np.isnan(values[0]):
        return ""
    shown = [f"{value:.4g}" for value in values]
    return shown[0] if shown[0] == shown[-1] else " / ".join(shown)
