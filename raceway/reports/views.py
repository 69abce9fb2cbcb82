"""One view of a record on one picture: what an analyst looks at, with the fault lines where they belong.

The lines are drawn over orders of the shaft. At a varying speed the signal is resampled over the angle of the shaft, so
that they stand still. Every view takes the mean away, and shows the healthy recording where two curves can be compared.
"""

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from features.signal.cyclic import spectral_coherence
from features.signal.impulsive import kurtogram
from features.signal.orders import order_map, order_spectrum, resample_to_angle
from features.signal.rows import FloatArray
from features.signal.spectra import cepstrum
from features.table.band import DEFAULT_BAND, checked_band
from gen.corpus.fault_classes import SHAFT, fundamentals
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.maps import BRIGHTEST_DB, FAINTEST, draw_coherence, draw_grid, level_over_median, plot
from raceway.reports.pictures import (
    FAINT,
    PER_TURN,
    STYLE,
    WIDTH,
    Drawing,
    DrawnRecord,
    draw_cursors,
    draw_density,
    draw_envelope_spectrum,
    draw_record,
    draw_waveform,
    envelope_over_angle,
    fault_lines,
    looks,
    name_lines,
    write_title,
)
from raceway.reports.subject import shown_record

HEIGHT = 3.6  # inches
MAP_TURNS = 24  # revolutions of a window of the waterfall
CEPSTRUM_TURNS = 1.3  # end of the axis, in revolutions
SHORTEST_CEPSTRUM = 0.06  # revolutions: what lies below is the shape of the spectrum
COHERENCE_BAND = 200.0  # Hz


def plot_record(
    record: xr.Dataset,
    view: str | None = None,
    *,
    healthy: xr.Dataset | None = None,
    channel: int | str = 0,
    band: tuple[float, float] = DEFAULT_BAND,
) -> Figure:
    """Draw a record as ``raceway plot`` does.

    A notebook shows the figure, and ``figure.savefig("record.png")`` writes it; it is none of pyplot, so ``plt.savefig`` writes another.

    Parameters
    ----------
    record
        One record, as ``gen.record(...)`` or ``corpus.isel(record=17)``.
    view
        One of `VIEWS`; by default waveform, power spectral density and squared envelope spectrum.
    healthy
        Another record, which is drawn under it.
    channel, band
        Number or name of the channel, and band of the envelope [Hz].

    Raises
    ------
    CorpusError
        If a Dataset is not one record of the format, or cannot be drawn.
    ValueError
        For another view, or if the record is too short for it.
    """
    if view is not None and view not in VIEWS:
        raise ValueError(f"view: {view!r} is none of {', '.join(VIEWS)}.")
    shown, *under = (shown_record(of, None, channel, checked_band(*band)) for of in (record, healthy) if of is not None)
    return draw_record(shown, *under) if view is None else draw_view(view, shown, *under)


@rc_context(STYLE)
def draw_view(view: str, shown: DrawnRecord, under: DrawnRecord | None = None) -> Figure:
    """Draw one of `VIEWS` of a record over that of another one.

    Raises
    ------
    ValueError
        If the record is too short for the view, or a view of one record is asked for two.
    """
    if under is not None and view in MAPS:
        raise ValueError("it shows one record alone; leave out the healthy one, or draw both.")
    figure = Drawing(figsize=(WIDTH, HEIGHT), layout="constrained")
    write_title(figure, shown)
    axes = figure.subplots()
    VIEWS[view](axes, shown, under)
    if under is not None:
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower right", ncols=2)
    return figure


def _orders(axes: Axes, shown: DrawnRecord, under: DrawnRecord | None) -> None:
    """Amplitude spectrum of the signal over orders."""
    top = draw_cursors(axes, shown)
    for record, look in looks(shown, under):
        orders, spectrum = order_spectrum(_over_angle(record), PER_TURN)
        drawn = (orders > 0) & (orders <= top)
        axes.semilogy(orders[drawn], np.maximum(spectrum[0, drawn], FAINTEST), linewidth=0.7, **look)
    axes.set(ylabel=f"amplitude [{shown.unit}]")
    axes.set_title("Order spectrum of the signal", pad=30)


def _over_angle(shown: DrawnRecord, per_turn: int = PER_TURN) -> FloatArray:
    return resample_to_angle((shown.signal - shown.signal.mean())[None], 2 * np.pi * shown.turns[None], per_turn)


def _waterfall(axes: Axes, shown: DrawnRecord, _: DrawnRecord | None) -> None:
    """Envelope spectra of windows over orders, one above the other."""
    orders, time, level = envelope_map(shown, draw_cursors(axes, shown))
    draw_grid(axes, (orders, time, level), (0.0, BRIGHTEST_DB), "dB above the median")
    axes.set(ylabel="time [s]")
    axes.set_title("Envelope spectrum of the whitened band over time", pad=30)


def envelope_map(shown: DrawnRecord, top: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Orders up to ``top``, times [s], and levels over the median [dB] of the envelope spectra of windows, shape (time, order).

    Raises
    ------
    ValueError
        If the record has fewer than two turns.
    """
    y = envelope_over_angle(shown)
    orders = order_map(y, PER_TURN, min(MAP_TURNS, max(2, y.shape[1] // PER_TURN // 4)))
    drawn = (orders.orders > 0) & (orders.orders <= top)
    amplitude = orders.amplitude[0][:, drawn]
    first = np.ceil(shown.turns[0])
    time = np.interp(first + orders.turns, shown.turns, np.arange(shown.signal.size) / shown.fs)
    return orders.orders[drawn], time, level_over_median(amplitude)


def _kurtogram(axes: Axes, shown: DrawnRecord, _: DrawnRecord | None) -> None:
    """Kurtosis of the analytic signal of each band, a row for each division of the spectrum."""
    plot(kurtogram(shown.signal, shown.fs), axes)


def _coherence(axes: Axes, shown: DrawnRecord, _: DrawnRecord | None) -> None:
    """Squared spectral coherence over orders of the envelope and frequency; what noise reaches stays white."""
    top = draw_cursors(axes, shown)
    rate = shown.shaft_rate
    x, fs = shown.signal[None], shown.fs
    if shown.angle is not None:  # at equal angles, the shaft turns once in a unit of time
        per_turn = round(fs / rate)
        x, fs, rate = _over_angle(shown, per_turn), float(per_turn), 1.0
    coherence = spectral_coherence(x, fs, top * rate, resolution=COHERENCE_BAND * rate / shown.shaft_rate)
    first = int(0.5 * rate / coherence.cyclic[1])  # near 0 any signal is coherent with itself
    draw_coherence(axes, coherence, coherence.squared[0], first, rate, 1e3 * rate / shown.shaft_rate)
    axes.set(ylabel="frequency [kHz]" if shown.angle is None else "frequency at the mean speed [kHz]")
    axes.set_title("Spectral coherence; noise reaches the lowest grey once in a hundred pictures", pad=30)


def _cepstrum(axes: Axes, shown: DrawnRecord, under: DrawnRecord | None) -> None:
    """Real cepstrum over revolutions: a family of lines is a peak at one revolution over its order, and at its multiples."""
    own, others = fault_lines(shown.orders, shown.fault)
    named = {line.label for line in (SHAFT, *fundamentals())}
    own, others = ({name: 1 / order for name, order in lines.items() if name in named} for lines in (own, others))
    colour = FAULT_COLOURS[shown.fault]
    for lines, ink in ((own, colour), (others, FAINT)):
        for place in lines.values():
            axes.axvline(place, color=ink, linewidth=0.7, linestyle=(0, (2, 2)))
    name_lines(
        axes, own, {name: place for name, place in others.items() if place < CEPSTRUM_TURNS}, colour, CEPSTRUM_TURNS
    )
    # over the angle if the speed varies, so that peaks stay narrow
    for record, look in looks(shown, under):
        y, rate = (
            (_over_angle(record), float(PER_TURN))
            if record.angle is not None
            else (record.signal[None], record.fs / record.shaft_rate)
        )
        values = cepstrum(y)[0]
        at = np.arange(values.size) / rate
        drawn = (at > SHORTEST_CEPSTRUM) & (at < CEPSTRUM_TURNS)
        axes.plot(at[drawn], values[drawn], linewidth=0.6, **look)
    axes.set(xlabel="quefrency [revolutions]", ylabel="real cepstrum", xlim=(0, CEPSTRUM_TURNS))
    axes.set_title("Cepstrum", pad=30)


VIEWS: Mapping[str, Callable[[Axes, DrawnRecord, DrawnRecord | None], None]] = {
    "waveform": draw_waveform,
    "psd": draw_density,
    "envelope": draw_envelope_spectrum,
    "kurtogram": _kurtogram,
    "coherence": _coherence,
    "orders": _orders,
    "waterfall": _waterfall,
    "cepstrum": _cepstrum,
}
"""Views by name: each draws a record, over that of another one."""
MAPS = ("kurtogram", "coherence", "waterfall")
"""Views that show one record."""
