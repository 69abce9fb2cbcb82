"""Drawings of what `features.signal` computes as a map: kurtogram, order map, spectral coherence.

``raceway.plot(signal.kurtogram(x, fs))`` draws into the current axes of pyplot, or into given ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from features.signal.arguments import fault_orders
from features.signal.cyclic import Coherence
from features.signal.impulsive import BandTree
from features.signal.orders import OrderMap
from features.signal.rows import FloatArray
from features.table.indicators import Orders
from gen.corpus.fault_classes import UNKNOWN
from gen.support.units import from_si
from raceway.reports.pictures import INK, VERMILION, fault_lines, highest_drawn_order, name_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HIGHEST_ORDER = 20.0  # shown of an order map: three harmonics of the lines of most bearings
BRIGHTEST_DB = 20.0  # level drawn black in an order map, above the median
COLUMNS = 340  # of a map
EMPTY = 1e-4  # of the highest amplitude of a window: the filter of resampling leaves less beyond half the sample rate
FAINTEST = 1e-12  # of an amplitude
NEAR_ZERO = 12  # first cyclic frequencies, at which any signal is coherent with itself
ONE_FALSE_ALARM = 0.01  # expected in a whole map of coherence of noise


def plot(
    result: BandTree | OrderMap | Coherence,
    axes: Axes | None = None,
    *,
    record: int = 0,
    orders: Sequence[float] | None = None,
) -> Axes:
    """Draw a result of `features.signal.kurtogram`, `comb_bands`, `order_map` or `spectral_coherence`.

    Parameters
    ----------
    result
        Of one record, or of several.
    axes
        Axes of matplotlib; by default the current ones of pyplot.
    record
        Place of the drawn record among several.
    orders
        Nominal fault orders ``ftf, bpfo, bpfi, bsf`` whose lines are drawn over an order map, which ends beyond their third harmonics;
        without them it ends at order 20, and ``axes.set_xlim`` shows more.

    Raises
    ------
    TypeError
        For another result.
    ValueError
        If orders are given with another result than an order map.
    """
    if orders is not None and not isinstance(result, OrderMap):
        raise ValueError("orders: are drawn over an order map alone; leave them out.")
    if axes is None:
        from matplotlib import pyplot as plt

        axes = plt.gca()
    match result:
        case BandTree():
            _draw_bands(axes, result, np.atleast_2d(result.score)[record])
        case OrderMap():
            # of several records one is drawn
            amplitude = result.amplitude if result.amplitude.ndim == 2 else result.amplitude[record]
            level = level_over_median(amplitude[:, 1:])
            draw_grid(axes, (result.orders[1:], result.turns, level), (0.0, BRIGHTEST_DB), "dB above the median")
            top = HIGHEST_ORDER if orders is None else _draw_lines(axes, orders)
            axes.set(xlabel="order of the shaft", ylabel="turns of the shaft", xlim=(0, min(top, result.orders[-1])))
        case Coherence():
            squared = result.squared if result.squared.ndim == 2 else result.squared[record]
            draw_coherence(axes, result, squared, NEAR_ZERO, 1.0, 1e3)
            axes.set(xlabel="cyclic frequency [Hz]", ylabel="frequency [kHz]")
        case _:
            raise TypeError(f"plot: {type(result).__name__} is not a BandTree, OrderMap or Coherence.")
    return axes


def _draw_lines(axes: Axes, orders: Sequence[float]) -> float:
    """Draw the fundamental lines of all classes with their names; return the order at which the axis ends."""
    named = Orders(*(np.asarray(order, dtype=float) for order in fault_orders(orders, "orders")))
    own, lines = fault_lines(named, UNKNOWN)
    for order in lines.values():
        axes.axvline(order, color=VERMILION, linewidth=0.7, linestyle=(0, (2, 2)))
    top = highest_drawn_order(own, lines)
    name_lines(axes, own, lines, INK, top)
    return top


def _draw_bands(axes: Axes, tree: BandTree, score: FloatArray) -> None:
    levels, edges, _, quantity = tree
    divisions, drawn = np.unique(levels), score[np.isfinite(score)]
    limits = {"vmin": min(0.0, float(drawn.min())), "vmax": max(1.0, float(drawn.max())), "cmap": "Greys"}
    mesh: Any = None
    # a row for each division of the frequencies, its bands side by side
    for row, division in enumerate(divisions):
        chosen = levels == division
        across = from_si(np.append(edges[chosen, 0], edges[chosen, 1][-1]), "khz")
        mesh = axes.pcolormesh(across, [row - 0.5, row + 0.5], score[chosen][None], rasterized=True, **limits)
    # the best band is framed and named
    best = int(np.argmax(score))
    low, high = from_si(edges[best], "khz")
    row = int(np.searchsorted(divisions, levels[best]))
    axes.plot([low, high, high, low, low], row + np.array([-0.5, -0.5, 0.5, 0.5, -0.5]), color=VERMILION)
    axes.set_yticks(range(len(divisions)), [f"{division}" for division in divisions])
    axes.set(xlabel="frequency [kHz]", ylabel="number of bands", xlim=(0, from_si(edges.max(), "khz")))
    axes.invert_yaxis()
    axes.figure.colorbar(mesh, ax=axes, label=quantity, pad=0.01)
    axes.set_title(f"Highest {quantity}: {score[best]:.3g}, in {low:.3g}-{high:.3g} kHz")


def level_over_median(amplitude: FloatArray) -> FloatArray:
    """Level of spectra over the median of each [dB], shape (window, order); orders beyond the sample rate of the recording do not count."""
    held = np.where(amplitude >= EMPTY * amplitude.max(axis=1, keepdims=True), amplitude, np.nan)
    median = np.nanmedian(held, axis=1, keepdims=True)
    return 20 * np.log10(np.maximum(amplitude, FAINTEST) / np.maximum(median, FAINTEST))


def draw_coherence(
    axes: Axes, coherence: Coherence, squared: FloatArray, first: int, per_cyclic: float, per_spectral: float
) -> None:
    """Draw squared coherence of shape (spectral, cyclic) from the cyclic frequency of a number on; what noise reaches stays white.

    The axes are divided by the last two numbers. Of the fine grid, each column shows its highest value.
    """
    lowest = coherence.threshold(ONE_FALSE_ALARM / squared.size)
    starts = np.arange(first, len(coherence.cyclic), max(1, len(coherence.cyclic) // COLUMNS))
    highest = np.maximum.reduceat(squared, starts, axis=1)
    grid = coherence.cyclic[starts] / per_cyclic, coherence.spectral / per_spectral, highest
    draw_grid(axes, grid, (lowest, max(2 * lowest, float(highest.max()))), "squared coherence")


def draw_grid(
    axes: Axes, grid: tuple[FloatArray, FloatArray, FloatArray], limits: tuple[float, float], label: str
) -> None:
    """Draw shades of grey over x, shape (column,), and y, shape (row,); values below the lower limit stay white."""
    mesh = axes.pcolormesh(
        *grid, cmap="Greys", vmin=limits[0], vmax=limits[1], shading="nearest", rasterized=True, zorder=0
    )
    axes.figure.colorbar(mesh, ax=axes, label=label, pad=0.01)
