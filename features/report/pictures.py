"""Pictures of records, corpora and scores, drawn from plain arrays.

All colours, those of `features.faults` included, are from the palette of Okabe and Ito [1]_, which colour-blind readers
can distinguish. Pictures contain numbers and class names, and no text of a corpus.

.. [1] M. Okabe, K. Ito, "Color Universal Design: how to make figures and presentations that are friendly to colorblind
       people", 2008.
"""

import io
from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from features.band import DEFAULT_BAND, Band
from features.faults import FUNDAMENTALS, HEALTHY, LOOKS, SHAFT
from features.indicators import WHITENING_WIDTH, Orders
from features.signal.demodulation import analytic_band, squared_envelope_spectrum
from features.signal.rows import FloatArray, IntArray
from features.signal.spectra import fourier_coefficients, psd, whiten_by_psd
from gen.corpus import FAULT_NAMES, GENERATOR, check_result, write_durably
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    from features.baselines import Baseline, Scores

PictureFormat = Literal["png", "svg", "pdf"]
FORMATS: Mapping[str, PictureFormat] = {".png": "png", ".svg": "svg", ".pdf": "pdf"}

INK, FAINT = "#222222", "#8a8a8a"
BLUE, VERMILION = "#0072B2", "#D55E00"
TEST_MARKERS = ((VERMILION, "s"), ("#009E73", "^"), ("#CC79A7", "v"), ("#E69F00", "P"))
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
UNDER: Any = {"color": LOOKS[HEALTHY].colour, "label": "healthy recording"}
WIDTH = 6.2  # inches: text stays readable on a phone

TURNS = 8  # shaft revolutions in the waveform
COLUMNS = 1500  # columns that a long waveform is reduced to
TOLD_MEAN = 0.01  # of the standard deviation, from which the title tells the mean that is removed
SEGMENT = 0.05  # s, window of the power spectral density
FAINTEST_DB = 120.0  # lowest density drawn, below the highest
TOLERANCE = 0.02  # of an order, half the width of the shaded band around a line of the fault


class Shown(NamedTuple):
    """A record to draw: title, signal, shape (time,), sample and shaft rate [Hz], fault orders, class, band of the envelope, and unit."""

    title: str
    signal: FloatArray
    fs: float
    shaft_rate: float
    orders: Orders
    fault: str
    band: Band = DEFAULT_BAND
    unit: str = "m/s²"


class Quantity(NamedTuple):
    """Values of a per-record variable, in the unit of its label, shape (record,)."""

    label: str
    values: FloatArray


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


def check_picture(path: Path) -> PictureFormat:
    """Format of a picture by the suffix of its file; CorpusError for another suffix, or a file that may not be replaced."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise CorpusError(f"{path}: {path.suffix or 'no suffix'} is no format of pictures; use .png, .svg or .pdf.")
    check_result(path, "picture")
    return FORMATS[suffix]


def write_picture(figure: Figure, path: Path) -> None:
    """Write a figure as .png, .svg or .pdf, whole or not at all; CorpusError as `check_picture`, or if the disk refuses it."""
    write_durably(picture(figure, check_picture(path)), path)


@rc_context(STYLE)
def draw_record(shown: Shown) -> Figure:
    """Waveform, power spectral density, and squared envelope spectrum with the fault lines, one above the other."""
    figure = Figure(figsize=(WIDTH, 6.8), layout="constrained")
    figure.suptitle(shown.title, x=0.01, ha="left", fontsize=11, fontweight="bold", color=LOOKS[shown.fault].colour)
    waveform, density, envelope = figure.subplots(3, 1, height_ratios=(1, 1, 1.25))
    draw_waveform(waveform, shown)
    draw_density(density, shown, shown.band)
    draw_envelope_spectrum(envelope, shown)
    figure.align_ylabels()
    return figure


def draw_waveform(axes: Axes, shown: Shown, under: Shown | None = None) -> None:
    """Draw the first revolutions of the shaft without the mean of the signal, and those of another record; the weaker one hides none."""
    duration = shown.signal.size / shown.fs
    visible = min(duration, TURNS / shown.shaft_rate)
    for one, look in ((under, UNDER), (shown, OVER)):
        if one is not None:
            x = one.signal[: max(2, round(visible * one.fs))] - np.mean(one.signal)
            axes.plot(*thin(np.arange(x.size) / one.fs, x), linewidth=0.6, zorder=2 + 1 / (1 + np.std(x)), **look)
    axes.set(xlabel="time [s]", ylabel=f"acceleration [{shown.unit}]", xlim=(0, visible))
    mean = float(np.mean(shown.signal))
    removed = f"; mean of {mean:.3g} {shown.unit} removed" if abs(mean) > TOLD_MEAN * np.std(shown.signal) else ""
    turns = f"{visible * shown.shaft_rate:.2g} shaft revolutions"
    axes.set_title(f"Waveform: first {visible:.2g} s of {duration:.3g} s, {turns}{removed}")


def thin(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest value in each of at most `COLUMNS` columns; the drawn line looks like that of all samples."""
    step = -(-values.size // COLUMNS)
    if step < 4:
        return time, values
    blocks = np.pad(values, (0, -values.size % step), mode="edge").reshape(-1, step)
    extremes = np.stack([blocks.min(axis=1), blocks.max(axis=1)], axis=1).reshape(-1)
    return np.repeat(time[::step], 2), extremes


def draw_density(axes: Axes, shown: Shown, band: tuple[float, float], under: Shown | None = None) -> None:
    """Power spectral density over that of another record, with a band [Hz] shaded."""
    for one, look in ((under, UNDER), (shown, OVER)):
        if one is not None:
            frequencies, density = psd(one.signal[None], one.fs, SEGMENT)
            faintest = max(density.max() * 10 ** (-FAINTEST_DB / 10), np.finfo(float).tiny)
            axes.plot(frequencies / 1e3, 10 * np.log10(np.maximum(density[0], faintest)), linewidth=0.8, **look)
    low, high = band[0] / 1e3, min(band[1], shown.fs / 2) / 1e3
    axes.axvspan(low, high, color=FAINT, alpha=0.12, linewidth=0)
    axes.set(xlabel="frequency [kHz]", ylabel="PSD [dB]", xlim=(0, shown.fs / 2e3))
    axes.set_title(f"Power spectral density, dB re 1 ({shown.unit})²/Hz; envelope of {low:.3g}-{high:.3g} kHz shaded")


def draw_envelope_spectrum(axes: Axes, shown: Shown) -> None:
    """Squared envelope spectrum over orders, with the lines of the fault shaded and the others dashed."""
    order, spectrum = squared_envelope(shown)
    own, others = fault_lines(shown.orders, shown.fault)
    top = _highest_drawn_order(own, others)
    visible = order <= top
    colour = LOOKS[shown.fault].colour
    for line in own.values():
        axes.axvspan(line * (1 - TOLERANCE), line * (1 + TOLERANCE), color=colour, alpha=0.2, linewidth=0)
    for line in others.values():
        axes.axvline(line, color=FAINT, linewidth=0.7, linestyle=(0, (2, 2)))
    axes.plot(order[visible], spectrum[visible], color=INK, linewidth=0.8)
    axes.set(xlabel="order of the shaft", ylabel="squared envelope [1]", xlim=(0, top), ylim=(0, None))
    name_lines(axes, own, others, colour, top)
    axes.set_title("Squared envelope spectrum of the whitened band", pad=30)


def _highest_drawn_order(own: Mapping[str, float], others: Mapping[str, float]) -> float:
    """Order at which the axis ends: beyond the third harmonics of all classes.

    If all lines of the fault lie below the highest fundamental line, as those of a cage do, the axis ends just above
    that fundamental, because harmonics of other classes would compress the lines of the fault.
    """
    lines = {**own, **others}
    highest = max(lines[line.label] for line in FUNDAMENTALS)
    return (1.1 if own and max(own.values()) < highest else 3.15) * highest


def squared_envelope(shown: Shown) -> tuple[FloatArray, FloatArray]:
    """Orders of the shaft, and squared envelope spectrum of the whitened band [1], both of shape (order,)."""
    duration = shown.signal.size / shown.fs
    coefficients = fourier_coefficients(shown.signal[None], shown.fs, shown.band.high)
    whitened = whiten_by_psd(coefficients, round(WHITENING_WIDTH * duration))
    band = analytic_band(whitened, *(round(edge * duration) for edge in shown.band))
    frequencies, spectrum = squared_envelope_spectrum(band, band.shape[-1] / duration)
    scale = np.mean(np.abs(band) ** 2)
    return frequencies / shown.shaft_rate, spectrum[0] / (scale if scale > 0 else 1.0)


def fault_lines(orders: Orders, fault: str) -> tuple[dict[str, float], dict[str, float]]:
    """Orders of the lines of a fault class, and of the fundamental lines of the others and the shaft, by label."""
    nominal = {"shaft": 1.0} | {base: float(order) for base, order in orders._asdict().items()}
    own = {line.label: line.multiple * nominal[line.base] for line in LOOKS[fault].lines}
    compared = {line.label: line.multiple * nominal[line.base] for line in (SHAFT, *FUNDAMENTALS)}
    return own, {label: order for label, order in compared.items() if label not in own}


def name_lines(axes: Axes, own: Mapping[str, float], others: Mapping[str, float], colour: str, top: float) -> None:
    """Write the label of each line above the axes, in the lower of two rows if there is room."""
    ends = [-np.inf, -np.inf]
    per_letter = top / 78
    named = [(line, name, colour) for name, line in own.items()] + [(line, name, INK) for name, line in others.items()]
    for line, name, ink in sorted(named):
        half = (len(name) + 1) / 2 * per_letter
        row = 0 if line - half > ends[0] else int(np.argmin(ends))
        ends[row] = line + half
        weight = "normal" if ink == INK else "bold"
        axes.annotate(
            name, (line, 1), (0, 3 + 11 * row), ("data", "axes fraction"), "offset points",
            color=ink, fontsize=8, fontweight=weight, ha="center", va="bottom", annotation_clip=False,
        )  # fmt: skip


@rc_context(STYLE)
def draw_content(fault: IntArray, rig: IntArray, quantities: Sequence[Quantity]) -> Figure:
    """Records per rig, and histograms of the quantities that vary, stacked by class.

    Parameters
    ----------
    fault, rig
        Class and rig number of each record, shape (record,).
    quantities
        Each gets a histogram if it varies; values that are not finite are omitted.
    """
    quantities = [quantity for quantity in quantities if _varies(quantity.values)]
    rows = -(-(1 + len(quantities)) // 2)
    figure = Figure(figsize=(WIDTH, 0.4 + 1.9 * rows), layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False).ravel()
    present = np.unique(fault)
    _draw_rigs(panels[0], fault, rig, present)
    for axes, quantity in zip(panels[1:], quantities, strict=False):
        _draw_distribution(axes, fault, quantity, present)
    for axes in panels[1 + len(quantities) :]:
        axes.remove()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=len(FAULT_NAMES))
    return figure


def _draw_rigs(axes: Axes, fault: IntArray, rig: IntArray, present: IntArray) -> None:
    rigs, number = np.unique(rig, return_inverse=True)
    bottom = np.zeros(len(rigs))
    for c in present:
        count = np.bincount(number[fault == c], minlength=len(rigs))
        axes.bar(np.arange(len(rigs)), count, 0.8, bottom, color=LOOKS[FAULT_NAMES[c]].colour, label=FAULT_NAMES[c])
        bottom += count
    step = max(1, len(rigs) // 10)
    axes.set_xticks(np.arange(0, len(rigs), step), [str(name) for name in rigs[::step]])
    axes.set(xlabel="rig", ylabel="records")


def _varies(values: FloatArray) -> bool:
    finite = values[np.isfinite(values)]
    return finite.size > 0 and bool(finite.min() < finite.max())


def _draw_distribution(axes: Axes, fault: IntArray, quantity: Quantity, present: IntArray) -> None:
    finite = np.isfinite(quantity.values)
    values = quantity.values[finite]
    wide = values.min() > 0 and values.max() > 10 * values.min()
    spaced = np.geomspace if wide else np.linspace
    edges = spaced(values.min(), values.max(), 25)
    axes.hist(
        [values[fault[finite] == c] for c in present],
        bins=edges.tolist(),
        stacked=True,
        color=[LOOKS[FAULT_NAMES[c]].colour for c in present],
    )
    axes.set(xlabel=quantity.label, ylabel="records")
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


@rc_context(STYLE)
def draw_reliability(scores: Mapping[str, "Scores"]) -> Figure:
    """Accuracy against largest probability in bins, one panel for each of some scores by title."""
    columns = min(max(len(scores), 2), 3)
    rows = -(-len(scores) // columns)
    figure = Figure(figsize=(WIDTH, 2.7 * rows), layout="constrained")
    grid = figure.subplots(rows, columns, sharey=True, squeeze=False)
    panels = grid.ravel()
    for axes, (title, score) in zip(panels, scores.items(), strict=False):
        probability, accuracy = (
            [getattr(bin_, name) for bin_ in score.reliability] for name in ("probability", "accuracy")
        )
        area = 260 * np.array([bin_.records for bin_ in score.reliability]) / score.records
        axes.plot([0, 1], [0, 1], color=FAINT, linestyle=(0, (4, 3)), linewidth=0.9)
        axes.plot(probability, accuracy, color=BLUE, linewidth=0.8)
        axes.scatter(probability, accuracy, area + 4, color=BLUE, linewidth=0, zorder=3)
        axes.set(xlabel="largest probability", xlim=(0, 1.04), ylim=(-0.02, 1.06), aspect="equal")
        axes.set_title(f"{title}\ncalibration error {score.ece:.3f}")
    for axes in grid[:, 0]:
        axes.set_ylabel("accuracy")
    for axes in panels[len(scores) :]:
        axes.remove()
    return figure
