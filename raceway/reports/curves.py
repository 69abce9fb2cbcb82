"""Drawings of curves of scores: detection against width and against false alarms, and reliability."""

from collections.abc import Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from features.baselines import Scores
from features.baselines.detection import Roc, WidthBin
from gen.support.units import UNITS, from_si
from raceway.reports.pictures import BLUE, FAINT, INK, STYLE, VERMILION
from raceway.reports.templates import three_digits

PANEL = (2.6, 2.4)  # inches, of a figure that stands beside others
DASHED = (0, (4, 3))


@rc_context(STYLE)
def draw_detection(bins: Sequence[WidthBin], false_alarms: float | None) -> Figure:
    """Share of detected faults by their width, with intervals; and the share of false alarms."""
    figure, axes = _panel()
    draw_bins(axes, bins, UNITS["mm"].factor, BLUE, INK)
    set_size_axis(axes, [from_si(width_bin.width, "mm") for width_bin in bins])
    if false_alarms is not None:
        _draw_level(axes, "false alarms", false_alarms, VERMILION)
    axes.set(xlabel="width of the fault [mm]", ylabel="share detected", ylim=(-0.03, 1.05))
    return figure


def draw_bins(axes: Axes, bins: Sequence[WidthBin], unit: float, bars: str, dots: str) -> None:
    """Share detected in each range of sizes, with its interval, over the size in a unit."""
    size = [width_bin.width / unit for width_bin in bins]
    axes.vlines(
        size, [width_bin.low for width_bin in bins], [width_bin.high for width_bin in bins], color=bars, linewidth=1.2
    )
    # the area of a dot is the number of its records
    axes.scatter(
        size,
        [width_bin.detected for width_bin in bins],
        _areas([width_bin.records for width_bin in bins]),
        dots,
        linewidth=0,
        zorder=3,
    )


def set_size_axis(axes: Axes, size: Sequence[float]) -> None:
    """Logarithmic axis of sizes."""
    axes.set_xscale("log")
    # round numbers, or the ends of a range that has fewer than two
    smallest, largest = min(size), max(size)
    powers = 10.0 ** np.arange(np.floor(np.log10(smallest)), np.log10(largest) + 1)
    subs = (1, 2, 5) if largest < 100 * smallest else (1,)  # labels of more would overlap
    ticks = [tick for tick in np.outer(powers, subs).ravel().tolist() if smallest <= tick <= largest]
    ticks = ticks if len(ticks) > 1 else [smallest, largest]
    axes.set_xticks(ticks, map(three_digits, ticks))
    axes.xaxis.set_minor_locator(NullLocator())


@rc_context(STYLE)
def draw_roc(roc: Roc) -> Figure:
    """Share of detected faults against the share of false alarms, with its band."""
    figure, axes = _panel()
    if roc.interval is not None:
        axes.fill_between(roc.false_alarms, roc.low, roc.high, color=BLUE, alpha=0.2, linewidth=0)
    axes.plot([0, *roc.false_alarms], [0, *roc.detected], color=BLUE, linewidth=1.2)
    axes.plot([0, 1], [0, 1], color=FAINT, linestyle=DASHED, linewidth=0.9)
    axes.set(xlabel="share of false alarms", ylabel="share detected", xlim=(-0.03, 1.04), ylim=(-0.03, 1.05))
    return figure


@rc_context(STYLE)
def draw_reliability(scores: Scores) -> Figure:
    """Accuracy against largest probability in bins."""
    figure, axes = _panel()
    probability, accuracy = (
        [getattr(probability_bin, name) for probability_bin in scores.reliability]
        for name in ("probability", "accuracy")
    )
    axes.plot([0, 1], [0, 1], color=FAINT, linestyle=DASHED, linewidth=0.9)
    axes.plot(probability, accuracy, color=BLUE, linewidth=0.8)
    areas = _areas([probability_bin.records for probability_bin in scores.reliability])
    axes.scatter(probability, accuracy, areas, BLUE, linewidth=0, zorder=3, clip_on=False)
    axes.set(xlabel="largest probability", ylabel="accuracy", xlim=(-0.03, 1.04), ylim=(-0.03, 1.05))
    return figure


def _draw_level(axes: Axes, name: str, level: float, colour: str) -> None:
    """Dashed line with its name at the right end."""
    axes.axhline(level, color=colour, linestyle=DASHED, linewidth=0.9)
    axes.annotate(
        name, (1, level), (-2, 2), ("axes fraction", "data"), "offset points",
        color=INK, fontsize=8, ha="right", va="bottom",
    )  # fmt: skip


def _panel() -> tuple[Figure, Axes]:
    figure = Figure(figsize=PANEL, layout="constrained")
    return figure, figure.subplots()


def _areas(records: Sequence[int]) -> np.ndarray:
    """Areas of markers, proportional to numbers of records but for the least that can be seen."""
    return 4 + 150 * np.array(records) / sum(records)
