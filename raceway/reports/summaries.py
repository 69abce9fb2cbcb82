"""Pictures of the contents of corpora, and of scores."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from features.signal.rows import FloatArray, IntArray
from gen.corpus import FAULT_NAMES
from gen.corpus.choice import per_record
from gen.corpus.schema import stored_unit
from gen.support.units import READABLE, shown_unit
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import BLUE, FAINT, INK, STYLE, VERMILION, WIDTH

if TYPE_CHECKING:
    from features.baselines import Baseline, Scores

LONGEST_NAME = 40
TEST_MARKERS = ((VERMILION, "s"), ("#009E73", "^"), ("#CC79A7", "v"), ("#E69F00", "P"))


@rc_context(STYLE)
def draw_content(corpus: xr.Dataset) -> Figure:
    """Records per rig, and histograms of the `quantities` that vary, stacked by class; values that are not finite are omitted."""
    fault, rig = corpus["fault"].values, corpus["rig"].values
    # what has one value throughout needs no picture
    varying = {label: values for label, values in quantities(corpus).items() if _varies(values)}
    rows = -(-(1 + len(varying)) // 2)
    figure = Figure(figsize=(WIDTH, 0.4 + 1.5 * rows), layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False).ravel()
    present = np.unique(fault)
    _draw_rigs(panels[0], fault, rig, present)
    for axes, (label, values) in zip(panels[1:], varying.items(), strict=False):
        axes.set(xlabel=label, ylabel="records")
        _draw_distribution(axes, fault, values, present)
    for axes in panels[1 + len(varying) :]:
        axes.remove()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=len(FAULT_NAMES))
    return figure


def quantities(corpus: xr.Dataset) -> dict[str, FloatArray]:
    """Quantities whose distributions are drawn, by name and unit: operating conditions and labels with a unit, and levels.

    A label is 0 in a record without what it describes; such a record is left out of its distribution, NaN in shape (record,).
    """
    drawn = dict[str, FloatArray]()
    for name in filter(str.isidentifier, per_record(corpus)):
        role, unit = corpus[name].attrs["role"], stored_unit(corpus[name].attrs)
        measured = unit in READABLE and role in ("operating", "label")
        if corpus[name].dtype.kind == "f" and (measured or unit == "dB"):
            shown, factor = shown_unit(name, unit)
            values = corpus[name].values / factor
            named = f"{name[:LONGEST_NAME].replace('_', ' ')} [{shown}]"
            drawn[named] = np.where(values == 0, np.nan, values) if role == "label" else values
    return drawn


def _draw_rigs(axes: Axes, fault: IntArray, rig: IntArray, present: IntArray) -> None:
    rigs, number = np.unique(rig, return_inverse=True)
    bottom = np.zeros(len(rigs))
    for c in present:
        count = np.bincount(number[fault == c], minlength=len(rigs))
        axes.bar(np.arange(len(rigs)), count, 0.8, bottom, color=FAULT_COLOURS[FAULT_NAMES[c]], label=FAULT_NAMES[c])
        bottom += count
    step = -(-len(rigs) // 10)
    axes.set_xticks(np.arange(0, len(rigs), step), [str(name) for name in rigs[::step]])
    axes.set(xlabel="rig", ylabel="records")


def _varies(values: FloatArray) -> bool:
    finite = values[np.isfinite(values)]
    return finite.size > 0 and bool(finite.min() < finite.max())


def _draw_distribution(axes: Axes, fault: IntArray, values: FloatArray, present: IntArray) -> None:
    finite = np.isfinite(values)
    values = values[finite]
    # drawn log-uniformly, as most wide ranges are
    wide = values.min() > 0 and values.max() > 10 * values.min()
    spaced = np.geomspace if wide else np.linspace
    edges = spaced(values.min(), values.max(), 25)
    axes.hist(
        [values[fault[finite] == c] for c in present],
        bins=edges.tolist(),
        stacked=True,
        histtype="stepfilled",
        color=[FAULT_COLOURS[FAULT_NAMES[c]] for c in present],
    )
    axes.locator_params(axis="x", nbins=5)
    if wide:
        axes.set_xscale("log")
        subs = (1.0, 3.0) if values.max() > 100 * values.min() else (1.0, 2.0, 5.0)  # labels of more would overlap
        axes.xaxis.set_major_locator(LogLocator(subs=subs))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_locator(NullLocator())


@rc_context(STYLE)
def draw_scores(baselines: Mapping[str, "Baseline"], chance: float, unseen: str) -> Figure:
    """Balanced accuracy on unseen groups beside its controls, one row per baseline or track; bars are 95 % intervals."""
    scored = list(baselines.values())
    figure = Figure(figsize=(WIDTH, 1.2 + (0.4 + 0.05 * len(scored[0].tests)) * len(scored)), layout="constrained")
    axes = figure.subplots()
    rows = np.arange(len(baselines))[::-1]
    axes.hlines(rows, 0, 1, color=FAINT, linewidth=0.4, alpha=0.5)
    axes.vlines(chance, -0.6, len(rows) - 0.45, color=FAINT, linestyle=(0, (4, 3)), linewidth=0.9)
    axes.text(chance, len(rows) - 0.4, "chance", color=INK, fontsize=8, va="bottom", ha="center")
    # the score in the middle, other corpora below it, controls as hollow signs
    _draw_intervals(axes, [b.grouped for b in scored], rows + 0.13, BLUE, "o", f"unseen {unseen}")
    tests = zip(*(baseline.tests for baseline in scored), strict=True)
    for number, (test, (colour, marker)) in enumerate(zip(tests, cycle(TEST_MARKERS), strict=False), start=1):
        _draw_intervals(axes, test, rows - 0.1 - 0.09 * number, colour, marker, f"other corpus {number}")
    null, leaky = ([getattr(b, kind).balanced_accuracy for b in scored] for kind in ("null", "leaky"))
    axes.plot(
        leaky, rows + 0.13, "D", color=FAINT, markerfacecolor="none", markersize=9, label="random records (leaks)"
    )
    axes.plot(null, rows, "x", color=FAINT, markersize=6, label="labels permuted")
    axes.set_yticks(rows, [name.replace("_", " ") for name in baselines])
    axes.set(xlabel="balanced accuracy", xlim=(0, 1.02), ylim=(-0.6, len(rows) - 0.1))
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    figure.legend(loc="outside upper left", ncols=4, handletextpad=0.3, columnspacing=1.0)
    return figure


def _draw_intervals(
    axes: Axes, scores: "Sequence[Scores]", rows: FloatArray, colour: str, marker: str, label: str
) -> None:
    """Draw balanced accuracies, and the intervals that are known."""
    for score, row in zip(scores, rows, strict=True):
        if score.interval is not None:
            axes.hlines(row, *score.interval, color=colour, linewidth=1.6)
    axes.plot([score.balanced_accuracy for score in scores], rows, marker, color=colour, markersize=5.5, label=label)
