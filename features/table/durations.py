"""Durations of records: lines rise higher above the floor in longer ones, so a model suits records as long as those it was trained on."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr

DURATION = "duration"  # of each record of a feature table [s]


def durations_of(table: "xr.Dataset") -> tuple[float, ...]:
    """Shortest and longest duration of the records of a feature table [s]; empty if it does not tell them."""
    has_durations = DURATION in table and table.sizes["record"]
    return (float(table[DURATION].min()), float(table[DURATION].max())) if has_durations else ()
