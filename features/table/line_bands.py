"""Table of the bands in which the lines of bearing faults lie, and what a spectrum has in each of them.

``orders of a bearing, shaft rate -> fault_bands -> table; spectrum, table -> fault_metrics -> peak, power, level``

A fault line has harmonics, and sidebands at the rate at which the damage passes the load zone: that of the shaft for a
race, that of the cage for a ball [1]_. Slip, wear and errors of the labelled speed move lines by one or two per cent,
so each has a band around it.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from features.signal.arguments import fault_orders
from features.signal.demodulation import ZERO_PADDING, running_median
from features.signal.lines import LINE_TOLERANCE, Orders
from features.signal.rows import FloatArray
from features.table.indicators import FLOOR_WIDTH
from gen.corpus.fault_classes import CLASSES, SHAFT, FaultClass

if TYPE_CHECKING:
    import xarray as xr
    from pandas import DataFrame

HANN_BANDWIDTH = 1.5  # noise bandwidth of the Hann window, in resolutions
HALF_LINE = 2 * ZERO_PADDING  # points from the middle of a line to its end under a Hann window
METRICS = {
    "peak": "highest amplitude in the band",
    "peak_at": "frequency or order of the peak",
    "power": "mean square of the lines in the band",
    "level": "peak over the floor [dB]",
}


def fault_bands(
    orders: Sequence[float],
    shaft_rate: float,
    harmonics: int = 3,
    sidebands: int = 1,
    tolerance: float = LINE_TOLERANCE,
) -> DataFrame:
    """Bands of the fault lines of a bearing, one row per band.

    Parameters
    ----------
    orders
        Nominal orders ``ftf, bpfo, bpfi, bsf``, as `gen.bearing_orders` gives them.
    shaft_rate
        Rate of the shaft [Hz].
    harmonics
        Number of harmonics of each fault line.
    sidebands
        Number of sidebands to each side of each harmonic; the lines of the cage have none.
    tolerance
        Half the width of a band, relative to its middle.

    Returns
    -------
    DataFrame
        ``fault`` and ``line`` (names), ``harmonic``, ``sideband`` (negative below the harmonic), ``order``, ``order_low``,
        ``order_high``, and ``frequency``, ``low``, ``high`` [Hz].

    Raises
    ------
    ValueError
        If there is no harmonic, or a shaft rate, tolerance or order that is not positive.
    """
    import pandas as pd

    if not (shaft_rate > 0 and harmonics > 0 and sidebands >= 0 and 0 < tolerance < 1):
        raise ValueError(
            f"shaft_rate {shaft_rate}, harmonics {harmonics}, sidebands {sidebands}, tolerance {tolerance}: give a positive "
            f"rate, one harmonic or more, no negative number of sidebands and a tolerance between 0 and 1."
        )
    # the shaft is a family too: its order is 1
    nominal = dict(zip(Orders._fields, fault_orders(orders, "orders").tolist(), strict=True)) | {SHAFT.base: 1.0}
    rows = [
        (row.name, _label(row, harmonic, side), harmonic, side, _order(row, nominal, harmonic, side))
        for row in CLASSES.values()
        if row.evidence
        for harmonic in range(1, harmonics + 1)
        # lines of the cage or the shaft alone have no sidebands
        for side in (range(-sidebands, sidebands + 1) if row.comb else (0,))
    ]
    table = pd.DataFrame(rows, columns=["fault", "line", "harmonic", "sideband", "order"])
    table["order_low"], table["order_high"] = table.order * (1 - tolerance), table.order * (1 + tolerance)
    for name, order in (("frequency", "order"), ("low", "order_low"), ("high", "order_high")):
        table[name] = table[order] * shaft_rate
    return table


def _order(row: FaultClass, nominal: dict[str, float], harmonic: int, side: int) -> float:
    fundamental = row.lines[0]
    return harmonic * fundamental.multiple * nominal[fundamental.base] + side * nominal[row.side]


def _label(row: FaultClass, harmonic: int, side: int) -> str:
    """Name of a line, such as ``2 BPFI - shaft``."""
    fundamental, other = row.lines[0], SHAFT.label if row.side == SHAFT.base else row.side.upper()
    line = _times(harmonic * fundamental.multiple, fundamental.base.upper())
    return f"{line} {'+' if side > 0 else '-'} {_times(abs(side), other)}" if side else line


def _times(number: int, name: str) -> str:
    return name if number == 1 else f"{number} {name}"


def fault_metrics(
    frequencies: FloatArray, spectrum: FloatArray, bands: DataFrame, unit: Literal["Hz", "order"] = "Hz"
) -> DataFrame | xr.Dataset:
    """What an amplitude spectrum has in each band of `fault_bands`.

    ``peak`` is the highest amplitude, ``peak_at`` its place, ``power`` the mean square of the lines in the band (half the
    square of the amplitude of each), and ``level`` the peak over the running median of the spectrum around it [dB]. A line
    reaches two resolutions, which are two over the length of the record, to each side of its middle, so ``power`` is of the
    band and as much to each side. A band that reaches beyond the spectrum with them has NaN.

    Parameters
    ----------
    frequencies
        Equally spaced from 0, shape (frequency,), in ``unit``.
    spectrum
        Amplitudes, shape (frequency,) or (record, frequency), with four points in each resolution under a Hann window, as
        those of `envelope_spectrum` in `features.signal.demodulation` and of `features.signal.order_spectrum`.
    bands
        Table of `fault_bands`.
    unit
        Of the frequencies: ``Hz``, or ``order`` for multiples of the shaft rate.

    Returns
    -------
    DataFrame or Dataset
        One row per band, with its ``fault``, ``line``, ``harmonic`` and ``sideband``; of several records, a Dataset with
        the dimensions ``record`` and ``band``.
    """
    import xarray as xr

    values = np.atleast_2d(np.asarray(spectrum))
    step = float(frequencies[1] - frequencies[0])
    middle, low, high = (
        bands[column].to_numpy() / step
        for column in (("order", "order_low", "order_high") if unit == "order" else ("frequency", "low", "high"))
    )
    # from the table, since the spectrum may be over frequencies or over orders
    bins_per_order = middle[0] / bands["order"].iloc[0]
    bins_per_hz = middle[0] / bands["frequency"].iloc[0]
    width = max(FLOOR_WIDTH[0] * bins_per_order, FLOOR_WIDTH[1] * bins_per_hz)
    bins = min(int(high.max()) + 2, values.shape[1])
    # the floor under the lines, from what lies around them
    floor = running_median(values, np.full(len(values), width), bins)
    found = np.full((len(METRICS), len(values), len(bands)), np.nan)
    for band, place in enumerate(middle):
        # a band narrower than a bin holds the bin nearest to its line
        first, last = min(int(np.ceil(low[band])), round(place)), max(int(high[band]), round(place))
        if first >= HALF_LINE and last + HALF_LINE < values.shape[1]:
            found[:, :, band] = _metrics(values, floor, first, last, step)
    names = {name: bands[name].to_numpy() for name in ("fault", "line", "harmonic", "sideband")}
    # one spectrum gives a data frame, several a Dataset
    if np.ndim(spectrum) == 1:
        return bands[list(names)].assign(**dict(zip(METRICS, found[:, 0], strict=True)))
    return xr.Dataset(
        {
            name: (("record", "band"), metric, {"long_name": METRICS[name]})
            for name, metric in zip(METRICS, found, strict=True)
        },
        coords={name: ("band", of_bands) for name, of_bands in names.items()},
    )


def _metrics(values: FloatArray, floor: FloatArray, first: int, last: int, step: float) -> FloatArray:
    """Values of `METRICS` of one band from its bins, shape (metric, record)."""
    highest = first + values[:, first : last + 1].argmax(axis=1)
    rows = np.arange(len(values))
    peak, least = values[rows, highest], np.finfo(values.dtype).tiny
    lines = np.square(values[:, first - HALF_LINE : last + HALF_LINE + 1], dtype=float)
    power = np.sum(lines, axis=1) / (2 * HANN_BANDWIDTH * ZERO_PADDING)
    level = 20 * np.log10(np.maximum(peak, least) / np.maximum(floor[rows, highest], least))
    return np.stack([peak, highest * step, power, level])
