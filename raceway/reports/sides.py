"""Drawings of several sets side by side: an example of one class from each set, and the distributions of its measures.

The first set is the synthetic one.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from features.signal.rows import FloatArray
from features.signal.spectra import psd
from gen.support.units import from_si
from raceway.reports.pictures import (
    BLUE,
    INK,
    SEGMENT,
    STYLE,
    TURNS,
    VERMILION,
    WIDTH,
    DrawnRecord,
    mark_lines,
    squared_envelope,
    thin,
)

FAULT_COLOURS = (VERMILION, BLUE, "#009E73", "#CC79A7", "#E69F00", "#56B4E9")  # of the sets, as of the classes
COLUMN = 2.6  # inches, width of one set
FAINTEST_DB = -60.0
HIGHEST_ORDER = 17.0  # end of the axis of an envelope spectrum
DISTRIBUTION_COLUMNS = 3


@rc_context(STYLE)
def draw_sides(records: Mapping[int, DrawnRecord], top: float) -> Figure:
    """Waveform over its rms, power spectral density, and envelope spectrum of one record of each set, set beside set.

    The records are given by the number of their set, which sets the colour; ``top`` is the end of the axis of the density [Hz].
    """
    figure = Figure(figsize=(COLUMN * len(records), 5.0), layout="constrained")
    panels = figure.subplots(3, len(records), squeeze=False)
    # sets are compared on one scale
    for row in panels[:2]:
        for axes in row[1:]:
            axes.sharey(row[0])
    for column, (number, shown) in enumerate(records.items()):
        waveform, density, envelope = panels[:, column]
        x = shown.signal[: max(2, round(TURNS / shown.shaft_rate * shown.fs))]
        turns, values = thin(np.arange(x.size) / shown.fs * shown.shaft_rate, x / np.sqrt(np.mean(shown.signal**2)))
        waveform.plot(turns, values, color=INK, linewidth=0.5)
        waveform.set(xlabel="revolution of the shaft", xlim=(0, turns[-1]))
        waveform.set_title(shown.title, color=_colour(number), fontweight="bold", parse_math=False)
        frequencies, power = psd(shown.signal[None], shown.fs, SEGMENT)
        # over the whole energy, since gains of machines differ
        share = power[0] / power[0].sum()
        level = 10 * np.log10(np.maximum(share, 10 ** (FAINTEST_DB / 10)))
        density.plot(from_si(frequencies, "khz"), level, color=INK, linewidth=0.8)
        density.set(xlabel="frequency [kHz]", xlim=(0, from_si(top, "khz")))
        order, spectrum = squared_envelope(shown)
        visible = (order > 0) & (order <= HIGHEST_ORDER)
        mark_lines(envelope, shown)
        envelope.plot(order[visible], spectrum[visible], color=INK, linewidth=0.7)
        envelope.set(xlabel="order of the shaft", xlim=(0, HIGHEST_ORDER), ylim=(0, None))
    panels[0, 0].set_ylabel("acceleration / rms")
    panels[1, 0].set_ylabel("share of the energy [dB]")
    panels[2, 0].set_ylabel("envelope² / mean")
    return figure


def _colour(number: int) -> str:
    return FAULT_COLOURS[number % len(FAULT_COLOURS)]


@rc_context(STYLE)
def draw_distributions(measures: Mapping[str, Mapping[str, FloatArray]], names: Sequence[str]) -> Figure:
    """Share of the windows of each set below each value, one panel per measure.

    Parameters
    ----------
    measures
        By the label of a measure: finite values by the name of a set, shape (window,).
    names
        Of all sets, the synthetic one first.
    """
    rows = -(-len(measures) // DISTRIBUTION_COLUMNS)
    figure = Figure(figsize=(1.4 * WIDTH, 0.5 + 1.75 * rows), layout="constrained")
    panels = figure.subplots(rows, DISTRIBUTION_COLUMNS, squeeze=False, sharey=True).ravel()
    for axes, (label, sets) in zip(panels, measures.items(), strict=False):
        for number, name in enumerate(names):
            values = np.sort(sets.get(name, np.empty(0)))
            if values.size:
                share = (np.arange(values.size) + 0.5) / values.size
                axes.plot(values, share, color=_colour(number), linewidth=1.8 if number == 0 else 1.0)
        # the outermost hundredths of any set would squeeze all others
        inner = np.concatenate([np.quantile(values, (0.01, 0.99)) for values in sets.values() if values.size])
        if inner.size and inner.max() > inner.min():
            axes.set_xlim(inner.min(), inner.max())
        axes.set(xlabel=label, ylim=(0, 1))
        axes.locator_params(axis="x", nbins=5)
    # the last row may have places to spare
    for axes in panels[len(measures) :]:
        axes.remove()
    for number, name in enumerate(names):
        panels[0].plot([], [], color=_colour(number), label=name)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=len(names))
    figure.supylabel("share of the windows below", fontsize=9)
    return figure
