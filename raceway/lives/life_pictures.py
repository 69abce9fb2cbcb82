"""Pictures of lives: one bearing from its first snapshot to its end, and the courses of many beside those of another corpus."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from features.signal.rows import FloatArray
from features.signal.spectra import psd
from gen.corpus import SIGNAL, open_corpus, specimen_numbers
from gen.support.errors import CorpusError
from gen.support.units import from_si
from raceway.lives.prognosis import FIRST, check_lives
from raceway.reports.pictures import BLUE, FAINT, INK, STYLE, VERMILION, WIDTH

ABOVE: Any = {"loc": "lower left", "bbox_to_anchor": (0, 1), "ncols": 2, "borderaxespad": 0}
"""Place of a legend above its panel, where no curve crosses it."""


@rc_context(STYLE)
def draw_life(corpus: Path, bearing: str | None = None, like: Path | None = None) -> Figure:
    """One life as spectra over its age, its rms and the length of its spall; and the rms of all lives beside those of another corpus.

    The label of the figure is the name of the bearing.

    Parameters
    ----------
    corpus
        A corpus of lives.
    bearing
        Name of the bearing, or its number in the corpus from 0; by default the one that failed with most damaged snapshots.
    like
        Another corpus of lives.

    Raises
    ------
    CorpusError
        If a corpus has no lives, or not this bearing.
    """
    with open_corpus(corpus) as opened:
        life = _life(opened, corpus, bearing)
        signal, fs = _signal(life), float(life["sample_rate"][0])
        figure = Figure(figsize=(WIDTH, 6.5 if like is None else 8.5), layout="constrained")
        panels = figure.subplots(3 if like is None else 4, 1, height_ratios=[2, 1, 1, *([] if like is None else [1.5])])
        name = str(life["bearing"].values[0])
        figure.set_label(name)
        age = from_si(life["age"].values, "h")
        _draw_spectra(panels[0], age, signal, fs, name)
        rms = _rms(signal)
        panels[1].semilogy(age, rms / np.median(rms[:FIRST]), color=BLUE, linewidth=1)
        panels[1].set_ylabel("rms over\nits start")
        _plain_ticks(panels[1])
        panels[2].plot(age, from_si(life["spall_length"].values, "mm"), color=VERMILION, linewidth=1)
        panels[2].set(ylabel="spall [mm]", xlabel="age [h]")
        for axes in panels[:3]:
            axes.set_xlim(age[0], max(age[-1], age[0] + 1e-6))
        # when the spall begins, and when it can first be seen
        for name, style in (("initiation_time", ":"), ("first_detectable_time", "--")):
            at = from_si(float(life[name].values[0]), "h")
            if at <= age[-1]:
                for axes in panels[1:3]:
                    axes.axvline(at, color=INK, linestyle=style, linewidth=0.8, label=name.replace("_", " "))
                panels[1].legend(**ABOVE)
        # all lives beside those of the other corpus
        if like is not None:
            with open_corpus(like) as other:
                _draw_courses(panels[3], opened, other)
        return figure


def _plain_ticks(axes: Any) -> None:
    """Plain numbers on a logarithmic axis, without powers of ten."""
    low, high = axes.get_ylim()
    subs = (1.0, 2.0, 5.0) if high < 100 * low else (1.0,)  # labels of more would overlap
    axes.yaxis.set_major_locator(LogLocator(subs=subs))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_locator(NullLocator())


def _draw_spectra(axes: Any, age: FloatArray, signal: FloatArray, fs: float, title: str) -> None:
    frequency, density = psd(signal, fs, min(256 / fs, signal.shape[-1] / fs))
    level = 10 * np.log10(np.maximum(density.T, 1e-30))
    mesh = axes.pcolormesh(
        age, from_si(frequency, "khz"), level, vmin=np.quantile(level, 0.02), cmap="viridis", rasterized=True
    )
    axes.figure.colorbar(mesh, ax=axes, label="dB re 1 (m/s²)²/Hz", pad=0.01)
    axes.set(ylabel="frequency [kHz]", title=f"{title}: power spectral density over its life")


def _draw_courses(axes: Any, own: xr.Dataset, other: xr.Dataset) -> None:
    """Rms over its start against the share of life, of bearings that failed."""
    for records, colour, label in ((other, VERMILION, "the other corpus"), (own, BLUE, "this corpus")):
        for number, life in enumerate(_failed(records)):
            rms, age = _rms(_signal(life)), life["age"].values
            share = age / (age[-1] + life["rul"].values[-1])
            named = label if number == 0 else None
            axes.semilogy(
                100 * share, rms / np.median(rms[:FIRST]), color=colour, linewidth=0.7, alpha=0.6, label=named
            )
    axes.axhline(1, color=FAINT, linewidth=0.6)
    axes.set(xlabel="share of life [%]", ylabel="rms over\nits start")
    _plain_ticks(axes)
    axes.legend(**ABOVE)


def _life(records: xr.Dataset, corpus: Path, bearing: str | None) -> xr.Dataset:
    check_lives(records, str(corpus))
    if bearing is None:
        lives = sorted(_failed(records), key=lambda life: int((life["stage"].values > 0).sum()))
        if not lives:
            raise CorpusError(f"{corpus}: no bearing failed; name one.")
        return lives[-1]
    names, numbers = records["bearing"].values, specimen_numbers(records)
    places = np.flatnonzero(numbers.astype(str) == bearing if bearing.isdecimal() else names == bearing)
    if not len(places):
        named = ", ".join(dict.fromkeys(names.tolist()))
        raise CorpusError(f"{corpus}: has no bearing {bearing}; it has {named[:200]}.")
    if len(alike := np.unique(numbers[places])) > 1:
        listed = ", ".join(map(str, alike.tolist()))
        raise CorpusError(f"{corpus}: several bearings are called {bearing}; give the number of one: {listed[:200]}.")
    return records.isel(record=places)


def _failed(records: xr.Dataset) -> Iterator[xr.Dataset]:
    """Records of each bearing that failed."""
    numbers = specimen_numbers(records)
    for number in dict.fromkeys(numbers[records["event"].values == 1].tolist()):
        yield records.isel(record=np.flatnonzero(numbers == number))


def _signal(life: xr.Dataset) -> FloatArray:
    """First channel of the snapshots without its mean, shape (record, time) [m s-2]."""
    signal = life[SIGNAL].isel(channel=0).values.astype(np.float64)
    return signal - signal.mean(axis=-1, keepdims=True)


def _rms(signal: FloatArray) -> FloatArray:
    return np.sqrt((signal**2).mean(axis=-1))
