"""Tables and picture of docs/features.md: ``python -m benchmarks.feature_pages docs/features.md [PICTURE]``.

A test compares the page with the definitions.
"""

import sys
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import gen
from benchmarks.page_tables import filled, markdown
from features.signal.demodulation import analytic_band
from features.signal.spectra import band_energies, fourier_coefficients, psd
from features.table.band import DEFAULT_BAND
from features.table.definitions import GROUPS, define_features
from features.table.envelope_groups import VIEWS, without_view
from features.table.feature_group import Feature
from features.table.indicators import Orders
from features.table.record_batch import bands_of, levels_and_shape
from gen.support.units import from_si
from raceway.reports.pictures import BLUE, FAINT, INK, STYLE, VERMILION, picture

_HEADER = ("feature", "unit", "range", "meaning", "formula", "depends on", "source")
TURNS, HIGHEST_ORDER = 2, 13.0  # drawn shaft revolutions and orders


TABLES: Mapping[str, Sequence[Feature]] = {
    group: [*dict.fromkeys(map(without_view, define_features((group,))))] for group in GROUPS
}
"""Features of each built-in group; those of all views are one."""


def with_tables(page: str) -> str:
    """A page with its tables made again."""
    tables = {name: _features(features) for name, features in TABLES.items()}
    tables["views"] = markdown(("view", "meaning"), ((f"`{view}`", meaning) for view, meaning in VIEWS.items()))
    return filled(page, tables.__getitem__)


def _features(features: Sequence[Feature]) -> str:
    """Table of features; a column that is the same in all rows is a line above it."""
    columns = list(zip(_HEADER, zip(*map(_cells, features), strict=True), strict=True))
    varied = [(name, cells) for name, cells in columns if len(set(cells)) > 1]
    same = "; ".join(f"{name} {cells[0]}" for name, cells in columns if len(set(cells)) == 1)
    names, values = zip(*varied, strict=True)
    above = textwrap.fill(f"In all rows: {same}", 120) + "\n\n" if same else ""
    return above + markdown(names, zip(*values, strict=True))


def _cells(feature: Feature) -> Sequence[str]:
    formula = feature.formula.replace("|", "\\|")
    return (
        f"`{feature.name}`",
        feature.unit,
        feature.range,
        feature.meaning,
        f"`{formula}`",
        feature.parameters,
        feature.source,
    )


@rc_context(STYLE)
def draw_features() -> Figure:
    """A simulated spall on the outer race, and what each group of features measures of it."""
    record = gen.record(gen.outer(width_mm=0.8), bearing="6205", shaft_rpm=1480, duration_s=1, waviness_nm=20, seed=1)
    x, fs, rate = (
        record["acceleration"].values.reshape(1, -1),
        float(record["sample_rate"]),
        record["shaft_rate"].values,
    )
    orders = Orders(*(record[name].values.reshape(1) for name in Orders._fields))
    # the second band, in which the spall of this record stands out
    whitened = bands_of(fourier_coefficients(x, fs, DEFAULT_BAND.high), x.size / fs, fs)[1]
    level, _, bins = levels_and_shape([whitened], x.size / fs, rate.reshape(1), np.array([HIGHEST_ORDER]))
    figure = Figure(figsize=(7, 4.6), layout="constrained", dpi=72)
    (waveform, density), (envelope, spectrum) = figure.subplots(2, 2)
    _draw_moduli(waveform, x[0] - x.mean(), fs * TURNS / float(rate))
    waveform.set(title="time: the waveform, its rms and its peak", ylabel="acceleration [m/s²]")
    _draw_energies(density, *psd(x, fs))
    z = np.abs(analytic_band(whitened, 0, whitened.shape[-1])[0])
    _draw_moduli(envelope, z / np.sqrt(np.mean(z**2)), z.size / (x.size / fs) * TURNS / float(rate))
    envelope.set(title="shape: the envelope of the whitened band", ylabel="envelope over its rms")
    spectrum.plot(np.arange(level.shape[-1]) / bins, level[0, 0], color=INK, linewidth=0.7)
    for harmonic in (1, 2, 3):
        spectrum.axvline(harmonic * float(orders.bpfo[0]), color=VERMILION, linewidth=4, alpha=0.25)
    spectrum.set(title="lines: BPFO and harmonics over the floor", xlim=(0, HIGHEST_ORDER), ylim=(-2, None))
    spectrum.set(xlabel="order of the shaft", ylabel="level [Np]")
    return figure


def _draw_moduli(axes: Axes, values: np.ndarray, samples: float) -> None:
    """Draw some revolutions of a signal with its rms and its peak."""
    axes.plot(np.arange(round(samples)) * (TURNS / samples), values[: round(samples)], color=INK, linewidth=0.4)
    for height, colour in ((np.sqrt(np.mean(values**2)), BLUE), (np.abs(values).max(), VERMILION)):
        axes.axhline(height, color=colour, linewidth=1)
    axes.set(xlabel="shaft revolutions", xlim=(0, TURNS))


def _draw_energies(axes: Axes, frequencies: np.ndarray, density: np.ndarray) -> None:
    """Draw a power spectral density with its mean in each band."""
    edges = np.array(DEFAULT_BAND.energy_edges)
    means = band_energies(density, frequencies, edges)[0] / np.diff(edges)
    axes.plot(from_si(frequencies, "khz"), 10 * np.log10(density[0]), color=FAINT, linewidth=0.7)
    axes.stairs(10 * np.log10(means), from_si(edges, "khz"), baseline=None, color=BLUE, linewidth=1.5)
    axes.set(
        title="bands: mean power in each band",
        xlabel="frequency [kHz]",
        ylabel="PSD [dB]",
        xlim=(0, from_si(edges[-1], "khz")),
    )


if __name__ == "__main__":
    written, *pictures = map(Path, sys.argv[1:])
    written.write_text(with_tables(written.read_text(encoding="utf-8")), encoding="utf-8")
    for path in pictures:
        path.write_bytes(picture(draw_features(), "png"))
