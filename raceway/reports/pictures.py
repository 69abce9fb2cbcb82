"""Pictures of a record, drawn from plain arrays, and the style of all pictures.

All colours, those of `raceway.reports.class_colours` included, are from the palette of Okabe and Ito [1]_, which
colour-blind readers can distinguish. Pictures contain numbers and class names, and no text of a corpus.

.. [1] M. Okabe, K. Ito, "Color Universal Design: how to make figures and presentations that are friendly to colorblind
       people", 2008.
"""

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from features.signal.demodulation import amplitude_spectrum, analytic_band
from features.signal.orders import order_spectrum, resample_to_angle
from features.signal.rows import FloatArray, squared_modulus
from features.signal.spectra import fourier_coefficients, psd, whiten_by_psd
from features.table.band import DEFAULT_BAND, Band
from features.table.class_features import COMBS
from features.table.indicators import Orders
from features.table.record_batch import WHITENING_WIDTH
from gen.corpus import GENERATOR, check_result, write_durably
from gen.corpus.fault_classes import HEALTHY, SHAFT, UNKNOWN, fault_class, fundamentals
from gen.support.errors import CorpusError
from gen.support.units import from_si
from raceway.reports.class_colours import FAULT_COLOURS

PictureFormat = Literal["png", "svg", "pdf"]
FORMATS: Mapping[str, PictureFormat] = {".png": "png", ".svg": "svg", ".pdf": "pdf"}

INK, FAINT = "#222222", "#8a8a8a"
BLUE, VERMILION = "#0072B2", "#D55E00"
STYLE: Any = {
    "figure.facecolor": "white",
    "figure.dpi": 150,
    "font.size": 9,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlelocation": "left",
    "axes.titlesize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "svg.hashsalt": "raceway",
}
OVER: Any = {"color": INK, "label": "this recording"}
UNDER: Any = {"color": FAULT_COLOURS[HEALTHY], "label": "healthy recording"}
WIDTH = 6.2  # inches: text stays readable on a phone

TURNS = 8  # shaft revolutions in the waveform
PER_TURN = 128  # samples of an envelope over the angle of the shaft
COLUMNS = 1500  # columns that a long waveform is reduced to
TOLD_MEAN = 0.01  # of the standard deviation, from which the title tells the mean that is removed
SEGMENT = 0.05  # s, window of the power spectral density
FAINTEST_DB = 120.0  # lowest density drawn, below the highest
LETTERS_PER_INCH = 16  # of a label of a line
TOLERANCE = 0.02  # of an order, half the width of the shaded band around a line of the fault


class DrawnRecord(NamedTuple):
    """A record to draw.

    Attributes
    ----------
    title
        Heading, and for a varying speed its range.
    signal, fs
        Shape (time,), and its sample rate [Hz].
    shaft_rate
        Mean shaft rate [Hz].
    orders, fault
        Fault orders, and the class.
    band
        Of the envelope [Hz].
    unit
        Of the signal.
    angle
        Angle of the shaft at each sample [rad], shape (time,), None for a constant speed.
    """

    title: str
    signal: FloatArray
    fs: float
    shaft_rate: float
    orders: Orders
    fault: str
    band: Band = DEFAULT_BAND
    unit: str = "m/s²"
    angle: FloatArray | None = None

    @property
    def recorded_band(self) -> Band:
        """The band below half the sample rate [Hz]."""
        return Band(self.band.low, min(self.band.high, self.fs / 2))

    @property
    def turns(self) -> FloatArray:
        """Turns of the shaft since the first sample, shape (time,)."""
        if self.angle is None:
            return np.arange(self.signal.size) * (self.shaft_rate / self.fs)
        return (self.angle - self.angle[0]) / (2 * np.pi)


@rc_context(STYLE)
def picture(figure: Figure, suffix: PictureFormat) -> bytes:
    """Encode a figure; equal figures give equal bytes."""
    stream = io.BytesIO()
    facts = {
        "svg": {"Creator": GENERATOR, "Date": None},
        "pdf": {"Creator": GENERATOR, "CreationDate": None},
        "png": {"Software": GENERATOR},
    }[suffix]
    figure.savefig(stream, format=suffix, metadata=facts)
    return stream.getvalue()


def write_picture(figure: Figure, path: Path) -> None:
    """Write a figure as .png, .svg or .pdf, whole or not at all.

    Raises
    ------
    CorpusError
        For another suffix, if the file is no picture of Raceway, or if the disk refuses it.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise CorpusError(f"{path}: {path.suffix or 'no suffix'} is no format of pictures; use .png, .svg or .pdf.")
    check_result(path, "picture")
    write_durably(picture(figure, FORMATS[suffix]), path)


class Drawing(Figure):
    """A figure that a notebook shows, also one that does not use pyplot."""

    def _repr_png_(self) -> bytes:
        return picture(self, "png")


@rc_context(STYLE)
def draw_record(shown: DrawnRecord, under: DrawnRecord | None = None) -> Figure:
    """Waveform, power spectral density, and squared envelope spectrum with the fault lines, one above the other."""
    figure = Drawing(figsize=(WIDTH, 5.8), layout="constrained")
    write_title(figure, shown)
    waveform, density, envelope = figure.subplots(3, 1, height_ratios=(1, 1, 1.25))
    for draw, axes in ((draw_waveform, waveform), (draw_density, density), (draw_envelope_spectrum, envelope)):
        draw(axes, shown, under)
    if under is not None:
        figure.legend(*waveform.get_legend_handles_labels(), loc="outside lower right", ncols=2)
    figure.align_ylabels()
    return figure


def looks(shown: DrawnRecord, under: DrawnRecord | None) -> list[tuple[DrawnRecord, Any]]:
    """Records in the order in which they are drawn, each with its look; ValueError if the one beneath is of another class than healthy."""
    if under is not None and under.fault not in (HEALTHY, UNKNOWN):
        raise ValueError(f"the record beneath is of class {under.fault}; give a healthy one.")
    return [(shown, OVER)] if under is None else [(under, UNDER), (shown, OVER)]


def write_title(figure: Figure, shown: DrawnRecord) -> None:
    """Write the title of a record; a name of a file or channel is no formula, whatever signs it has."""
    colour = FAULT_COLOURS[shown.fault]
    figure.suptitle(shown.title, x=0.01, ha="left", fontsize=11, fontweight="bold", color=colour, parse_math=False)


def draw_waveform(axes: Axes, shown: DrawnRecord, under: DrawnRecord | None = None) -> None:
    """Draw the first revolutions of the shaft without the mean of the signal, and those of another record; the weaker one hides none."""
    duration, turned = shown.signal.size / shown.fs, shown.turns
    visible = int(np.searchsorted(turned, TURNS)) / shown.fs
    for record, look in looks(shown, under):
        # the weaker of both is drawn above the stronger one
        x = record.signal[: max(2, round(visible * record.fs))] - np.mean(record.signal)
        axes.plot(*thin(np.arange(x.size) / record.fs, x), linewidth=0.6, zorder=2 + 1 / (1 + np.std(x)), **look)
    axes.set(xlabel="time [s]", ylabel=f"acceleration [{shown.unit}]", xlim=(0, visible))
    mean = float(np.mean(shown.signal))
    removed = f"; mean of {mean:.3g} {shown.unit} removed" if abs(mean) > TOLD_MEAN * np.std(shown.signal) else ""
    turns = f"{min(TURNS, turned[-1]):.2g} shaft revolutions"
    axes.set_title(f"Waveform: first {visible:.2g} s of {duration:.3g} s, {turns}{removed}")


def thin(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest value in each of at most `COLUMNS` columns; the drawn line looks like that of all samples."""
    step = -(-values.size // COLUMNS)
    if step < 4:
        return time, values
    blocks = np.pad(values, (0, -values.size % step), mode="edge").reshape(-1, step)
    extremes = np.stack([blocks.min(axis=1), blocks.max(axis=1)], axis=1).reshape(-1)
    return np.repeat(time[::step], 2), extremes


def draw_density(axes: Axes, shown: DrawnRecord, under: DrawnRecord | None = None) -> None:
    """Power spectral density over that of another record, with the band of the envelope shaded."""
    for record, look in looks(shown, under):
        frequencies, density = psd(record.signal[None], record.fs, SEGMENT)
        # an axis of some decades, whatever a silent line has
        faintest = max(density.max() * 10 ** (-FAINTEST_DB / 10), np.finfo(float).tiny)
        axes.plot(from_si(frequencies, "khz"), 10 * np.log10(np.maximum(density[0], faintest)), linewidth=0.8, **look)
    low, high = (from_si(edge, "khz") for edge in shown.recorded_band)
    axes.axvspan(low, high, color=FAINT, alpha=0.12, linewidth=0)
    axes.set(xlabel="frequency [kHz]", ylabel="PSD [dB]", xlim=(0, shown.fs / 2e3))
    axes.set_title(f"Power spectral density, dB re 1 ({shown.unit})²/Hz; envelope of {low:.3g}-{high:.3g} kHz shaded")


def draw_envelope_spectrum(axes: Axes, shown: DrawnRecord, under: DrawnRecord | None = None) -> None:
    """Squared envelope spectrum over orders over that of another record, with the fault lines."""
    top = draw_cursors(axes, shown)
    for record, look in looks(shown, under):
        order, spectrum = squared_envelope(record)
        axes.plot(order[order <= top], spectrum[order <= top], linewidth=0.8, **look)
    axes.set(ylabel="envelope² / mean", ylim=(0, None))
    low, high = (from_si(edge, "khz") for edge in shown.recorded_band)
    axes.set_title(f"Squared envelope spectrum of the whitened band {low:.3g}-{high:.3g} kHz", pad=30)


def draw_cursors(axes: Axes, shown: DrawnRecord) -> float:
    """Lines of the fault and of others over orders as `mark_lines`, with their names; the last order drawn."""
    own, others = mark_lines(axes, shown)
    top = highest_drawn_order(own, others)
    axes.set(xlabel="order of the shaft", xlim=(0, top))
    name_lines(axes, own, others, FAULT_COLOURS[shown.fault], top)
    return top


def mark_lines(axes: Axes, shown: DrawnRecord) -> tuple[dict[str, float], dict[str, float]]:
    """Lines of the fault over orders, shaded, with their sidebands dotted, and those of others dashed; both as `fault_lines`."""
    own, others = fault_lines(shown.orders, shown.fault)
    row, colour = fault_class(shown.fault), FAULT_COLOURS[shown.fault]
    side = float(getattr(shown.orders, row.side, SHAFT.multiple))
    for line in own.values():
        axes.axvspan(line * (1 - TOLERANCE), line * (1 + TOLERANCE), color=colour, alpha=0.2, linewidth=0)
        for beside in (line - side, line + side) if row.name in COMBS else ():
            axes.axvline(beside, color=colour, linewidth=0.6, linestyle=(0, (1, 2)))
    for line in others.values():
        axes.axvline(line, color=FAINT, linewidth=0.7, linestyle=(0, (2, 2)))
    return own, others


def highest_drawn_order(own: Mapping[str, float], others: Mapping[str, float]) -> float:
    """Order at which the axis ends: beyond the third harmonics of all classes.

    If all lines of the fault lie below the highest fundamental line, as those of a cage do, the axis ends just above
    that fundamental, because harmonics of other classes would compress the lines of the fault.
    """
    lines = {**own, **others}
    highest = max(lines[line.label] for line in fundamentals())
    return (1.1 if own and max(own.values()) < highest else 3.15) * highest


def squared_envelope(shown: DrawnRecord) -> tuple[FloatArray, FloatArray]:
    """Orders of the shaft, and squared envelope spectrum of the whitened band [1], both of shape (order,)."""
    if shown.angle is not None:
        orders, spectrum = order_spectrum(envelope_over_angle(shown), PER_TURN)
        return orders, spectrum[0]
    power, rate = _squared_envelope_of_band(shown)
    frequencies, spectrum = amplitude_spectrum(power, rate)
    return frequencies / shown.shaft_rate, spectrum[0]


def envelope_over_angle(shown: DrawnRecord) -> FloatArray:
    """Squared envelope of the whitened band at equal angles of the shaft, over its mean, shape (1, angle)."""
    power, rate = _squared_envelope_of_band(shown)
    at = np.arange(power.shape[1]) / rate
    turns = np.interp(at, np.arange(shown.signal.size) / shown.fs, shown.turns)
    return resample_to_angle(power - power.mean(), 2 * np.pi * turns[None], PER_TURN)


def _squared_envelope_of_band(shown: DrawnRecord) -> tuple[FloatArray, float]:
    """Squared envelope over its mean, shape (1, time), and its sample rate [Hz]."""
    duration = shown.signal.size / shown.fs
    coefficients = fourier_coefficients(shown.signal[None], shown.fs, shown.band.high)
    whitened = whiten_by_psd(coefficients, round(WHITENING_WIDTH * duration))
    power = squared_modulus(analytic_band(whitened, *(round(edge * duration) for edge in shown.band)))
    return power / max(float(power.mean()), np.finfo(np.float32).tiny), power.shape[-1] / duration


def fault_lines(orders: Orders, fault: str) -> tuple[dict[str, float], dict[str, float]]:
    """Orders of the lines of a fault class, and of the fundamental lines of the others and the shaft, by label."""
    own, compared = (
        {line.label: float(line.order(orders)) for line in lines}
        for lines in (fault_class(fault).lines, (SHAFT, *fundamentals()))
    )
    return own, {label: order for label, order in compared.items() if label not in own}


def name_lines(axes: Axes, own: Mapping[str, float], others: Mapping[str, float], colour: str, top: float) -> None:
    """Write the label of each line above the axes, in the lower of two rows if there is room, and beside its line if there is none."""
    ends = [-np.inf, -np.inf]
    # a layout makes the axes wider than they are now
    letters = LETTERS_PER_INCH * axes.bbox.width / axes.figure.dpi
    named = [(line, name, colour) for name, line in own.items()] + [(line, name, INK) for name, line in others.items()]
    for line, name, ink in sorted(named):
        half = (len(name) + 1) / 2 * top / letters
        row = 0 if line - half > ends[0] else int(np.argmin(ends))
        place = max(line, ends[row] + half)
        ends[row] = place + half
        weight = "normal" if ink == INK else "bold"
        axes.annotate(
            name, (place, 1), (0, 3 + 11 * row), ("data", "axes fraction"), "offset points",
            color=ink, fontsize=8, fontweight=weight, ha="center", va="bottom", annotation_clip=False,
        )  # fmt: skip
