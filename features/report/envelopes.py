"""Pictures of several envelope spectra: records side by side, and the pieces of a run-up as a waterfall with fault orders.

In a waterfall, lines that follow the shaft speed run along the drawn orders; lines at constant frequencies are vertical.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from features.faults import LOOKS
from features.report.pictures import (
    INK,
    STYLE,
    VERMILION,
    WIDTH,
    Shown,
    mark_lines,
    squared_envelope,
)
from features.signal.demodulation import analytic_band, envelope_spectrum
from features.signal.rows import FloatArray
from features.signal.spectra import fourier_coefficients

PIECE = 0.5  # s, length of a piece
OVERLAP = 0.75  # of a piece
BRIGHTEST_DB = 30.0  # level drawn black, above the median
HIGHEST_ORDER = 17.0  # end of the axis


def draw_envelope(axes: Axes, shown: Shown) -> None:
    """Squared envelope spectrum of one record over orders, with its lines marked."""
    order, spectrum = squared_envelope(shown)
    visible = (order > 0) & (order <= HIGHEST_ORDER)
    mark_lines(axes, shown)
    axes.plot(order[visible], spectrum[visible], color=INK, linewidth=0.7)
    axes.set(xlim=(0, HIGHEST_ORDER), ylim=(0, None))


@rc_context(STYLE)
def draw_envelopes(records: Sequence[Shown]) -> Figure:
    """Squared envelope spectra of several records in two columns."""
    rows = -(-len(records) // 2)
    figure = Figure(figsize=(2 * WIDTH, 1.75 * rows), layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False, sharex=True).ravel()
    for axes, shown in zip(panels, records, strict=False):
        draw_envelope(axes, shown)
        axes.set_title(shown.title, color=LOOKS[shown.fault].colour, fontweight="bold")
    for axes in panels[len(records) :]:
        axes.remove()
    figure.supxlabel("order of the shaft", fontsize=9)
    figure.supylabel("squared envelope of the whitened band [1]", fontsize=9)
    return figure


def envelope_pieces(
    signal: FloatArray, fs: float, band: tuple[float, float]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Envelope spectra of overlapping pieces of a record.

    Parameters
    ----------
    signal : array, shape (time,)
        Accelerations [m s-2].
    fs : float
        Sample rate [Hz].
    band : tuple of float
        Lower and upper edge of the band whose envelope is taken [Hz].

    Returns
    -------
    times : array, shape (piece,)
        Middle of each piece [s].
    frequencies : array, shape (frequency,)
        [Hz].
    spectra : array, shape (piece, frequency)
        [m s-2].
    """
    length = round(PIECE * fs)
    starts = np.arange(0, len(signal) - length + 1, round(length * (1 - OVERLAP)))
    pieces = np.stack([signal[start : start + length] for start in starts])
    coefficients = fourier_coefficients(pieces, fs, min(band[1], fs / 2))
    envelope = analytic_band(coefficients, *(round(edge * length / fs) for edge in band))
    frequencies, spectra = envelope_spectrum(envelope, envelope.shape[-1] / (length / fs))
    return (starts + length / 2) / fs, frequencies, spectra


@rc_context(STYLE)
def draw_waterfall(
    title: str,
    signal: FloatArray,
    fs: float,
    band: tuple[float, float],
    shaft_rate: FloatArray,
    lines: Mapping[str, float],
) -> Figure:
    """Envelope spectra of a record over time as shades of grey.

    ``shaft_rate`` is the rate at each sample, shape (time,) [Hz]; ``lines`` gives the orders to draw, by label.
    """
    times, frequencies, spectra = envelope_pieces(signal, fs, band)
    level = 20 * np.log10(spectra / np.median(spectra, axis=1, keepdims=True) + 1e-12)
    rate = np.interp(times, np.arange(len(shaft_rate)) / fs, shaft_rate)
    top = 1.1 * max(lines.values()) * rate.max()
    visible = (frequencies > 0) & (frequencies <= top)
    figure = Figure(figsize=(WIDTH, 4.2), layout="constrained")
    axes = figure.subplots()
    picture = axes.pcolormesh(
        frequencies[visible], times, level[:, visible], cmap="Greys", vmin=0, vmax=BRIGHTEST_DB, shading="nearest",
        rasterized=True,
    )  # fmt: skip
    for name, order in lines.items():
        axes.plot(order * rate, times, color=VERMILION, linewidth=0.8, linestyle=(0, (4, 6)))
        axes.annotate(
            name, (order * rate[-1], times[-1]), (0, 3), textcoords="offset points", fontsize=8, ha="center",
            color=VERMILION, annotation_clip=False,
        )  # fmt: skip
    axes.set(xlabel="frequency of the envelope [Hz]", ylabel="time [s]", xlim=(0, top))
    axes.set_title(title, pad=16, fontweight="bold")
    figure.colorbar(picture, ax=axes, label="dB above the median", pad=0.01)
    return figure
