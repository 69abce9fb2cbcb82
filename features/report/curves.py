"""Drawing of a learning curve."""

from collections.abc import Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from features.baselines import CurvePoint, Scores
from features.report.pictures import BLUE, FAINT, INK, STYLE, VERMILION, WIDTH


@rc_context(STYLE)
def draw_curve(points: Sequence[CurvePoint], chance: float, rule: Scores) -> Figure:
    """Balanced accuracy against the number of training specimens, with chance and the untrained envelope rule."""
    figure = Figure(figsize=(WIDTH, 3.2), layout="constrained")
    axes = figure.subplots()
    size = [point.specimens for point in points]
    known = [(point.specimens, *point.scores.interval) for point in points if point.scores.interval is not None]
    if known:
        sizes, low, high = np.transpose(known)
        axes.fill_between(sizes, low, high, color=BLUE, alpha=0.2, linewidth=0)
    axes.plot(size, [point.scores.balanced_accuracy for point in points], "o-", color=BLUE, markersize=5, linewidth=1.4)
    for level, name, colour in (
        (chance, "chance", FAINT),
        (rule.balanced_accuracy, "envelope rule, untrained", VERMILION),
    ):
        axes.axhline(level, color=colour, linestyle=(0, (4, 3)), linewidth=0.9)
        axes.annotate(
            name, (1, level), (-2, 2), ("axes fraction", "data"), "offset points",
            color=INK, fontsize=8, ha="right", va="bottom",
        )  # fmt: skip
    axes.set_xscale("log")
    axes.set_xticks(size, [str(n) for n in size])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set(xlabel="training specimens", ylabel="balanced accuracy", ylim=(0, 1.02))
    return figure
