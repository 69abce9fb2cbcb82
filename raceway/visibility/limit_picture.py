"""Picture of the share of records in which a fault is seen, over its size: a panel for each class, a curve for each criterion."""

from collections.abc import Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from features.baselines import percent_text
from gen.support.units import shown_unit
from raceway.reports.curves import DASHED, draw_bins, set_size_axis
from raceway.reports.pictures import BLUE, FAINT, STYLE, VERMILION, WIDTH
from raceway.visibility.fault_limits import FaultLimit
from raceway.visibility.size_curves import SHARES

LOOKS = {"twin": (BLUE, 1, 5), "classifier": (VERMILION, 1.03, 2)}
"""Colour, shift of the dots, and thickness of the bars, so that those of one criterion do not hide those of the other."""
HEIGHT = 2.2  # inches of a panel
TICKS = (0, *SHARES, 1)


@rc_context(STYLE)
def draw_limits(limits: Sequence[FaultLimit]) -> Figure:
    """Shares in ranges of the size, the curves through them, and the sizes seen in 50 and 90 %; bars are 95 % intervals."""
    panels = list(dict.fromkeys((of.fault, of.variable) for of in limits))
    figure = Figure(figsize=(WIDTH, HEIGHT * len(panels)), layout="constrained")
    places = figure.subplots(len(panels), squeeze=False)[:, 0]
    for of in limits:
        axes, (colour, shift, thickness) = places[panels.index((of.fault, of.variable))], LOOKS[of.criterion]
        unit, factor = shown_unit(of.variable, of.unit)
        draw_bins(axes, of.bins, factor / shift, colour, colour)
        (smallest, largest), (middle, slope) = of.extent, of.curve
        size = np.geomspace(smallest, largest, 200)
        axes.plot(size / factor, 1 / (1 + (middle / size) ** slope), color=colour, linewidth=1.2, label=of.criterion)
        for share, (_, *ends) in zip(SHARES, (of.seen_50, of.seen_90), strict=True):
            axes.axhline(share, color=FAINT, linestyle=DASHED, linewidth=0.7)
            axes.hlines(share, *np.clip(ends, smallest, largest) / factor, color=colour, linewidth=thickness)
        set_size_axis(axes, [smallest / factor, largest / factor])
        axes.set(xlabel=f"{of.variable.replace('_', ' ')} [{unit}]", ylabel=f"{of.fault} seen", ylim=(-0.03, 1.05))
        axes.set_yticks(TICKS, map(percent_text, TICKS))
    places[0].legend(loc="lower right")
    return figure
