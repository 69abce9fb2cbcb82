"""Durations of records: lines rise higher above the floor in longer ones, so a model suits records as long as those it was trained on."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from features.signal.rows import FloatArray

WINDOW = 0.5  # s, for a model that does not tell the duration of its training records
DURATION = "duration"  # of each record of a feature table [s]


def durations_of(table: "xr.Dataset") -> tuple[float, ...]:
    """Shortest and longest duration of the records of a feature table [s]; empty if it does not tell them."""
    has_durations = DURATION in table and table.sizes["record"]
    return (float(table[DURATION].min()), float(table[DURATION].max())) if has_durations else ()


def windows_of(signal: "FloatArray", fs: float, durations: "Sequence[float]") -> "FloatArray":
    """Consecutive windows of the longest of some durations [s], ([record,] time) to (window, time); a shorter signal is one window."""
    length = max(1, min(round(max(durations, default=WINDOW) * fs), signal.shape[-1]))
    count = signal.shape[-1] // length
    return signal[..., : count * length].reshape(-1, length)
