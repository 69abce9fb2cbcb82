"""A diagnosis on one self-contained page: verdict, probabilities, pictures, evidence and what was assumed."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from features.signal.rows import FloatArray
from features.signal.velocity import velocity_band
from features.table.band import Band
from features.table.class_features import COMBS
from gen.corpus.fault_classes import HEALTHY, SHAFT, families, fault_class
from gen.support.units import from_si
from raceway.diagnosis import FALSE_ALARM, LEAST_LEVEL, Diagnosis
from raceway.diagnosis.spectrum import BandSpectrum, band_spectra
from raceway.diagnosis.wording import probability_in_words
from raceway.importing.recorded import Recorded
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import (
    FAINT,
    INK,
    STYLE,
    UNDER,
    WIDTH,
    DrawnRecord,
    draw_density,
    draw_waveform,
    name_lines,
    picture,
)
from raceway.reports.templates import write_page

LOWEST_DB, MARGIN_DB = -5.0, 4.0  # ends of the axis of levels: below the floor, and above the highest
DRAWN_HARMONICS = 3  # of each family


def write_diagnosis(
    diagnosis: Diagnosis,
    recording: Recorded,
    output: Path | str,
    *,
    healthy: Sequence[Recorded] = (),
    name: str,
    assumed: Sequence[tuple[str, str]],
) -> None:
    """Write the page of a diagnosis.

    Parameters
    ----------
    diagnosis, recording
        The diagnosis, and the recording it is of.
    output
        The page, a file.
    healthy
        Healthy recordings of the machine; the first one is drawn.
    name
        Of the recording, for the title.
    assumed
        Facts that were given or assumed, such as the unit.

    Raises
    ------
    CorpusError
        If the disk refuses the file.
    """
    spectrum, under = diagnosis.spectrum, next(iter(healthy), None)
    write_page(
        Path(output),
        "diagnosis.html.jinja",
        "raceway.diagnosis",
        name=name,
        diagnosis=diagnosis,
        colour=FAULT_COLOURS.get(diagnosis.verdict, FAINT),
        # a useless signal has no spectrum
        picture=spectrum and picture(draw_diagnosis(diagnosis, spectrum, recording, under), "svg"),
        healthy=len(healthy),
        recording=recording,
        band=velocity_band(diagnosis.shaft_rate),
        colours=FAULT_COLOURS,
        least=LEAST_LEVEL,
        false_alarm=FALSE_ALARM,
        probability_in_words=probability_in_words,
        assumed=assumed,
    )


@rc_context(STYLE)
def draw_diagnosis(
    diagnosis: Diagnosis, spectrum: BandSpectrum, recording: Recorded, healthy: Recorded | None = None
) -> Figure:
    """Waveform, power spectral density, and envelope spectrum over its floor, one above the other, over those of a healthy recording."""
    shown = _shown(diagnosis, spectrum, recording)
    under = healthy and _shown(diagnosis, spectrum, healthy)
    figure = Figure(figsize=(WIDTH, 6.4), layout="constrained")
    waveform, density, envelope = figure.subplots(3, 1, height_ratios=(0.8, 0.8, 1.4))
    draw_waveform(waveform, shown, under)
    draw_density(density, shown, under)
    if under is not None:
        # in the band of the recording, which may not be the best one of the healthy recording
        (of_healthy,) = band_spectra(under.signal, under.fs, under.shaft_rate, spectrum.channel, [spectrum.band])
        envelope.plot(*_levels(of_healthy, diagnosis.shaft_rate), linewidth=0.7, **UNDER)
        figure.legend(*waveform.get_legend_handles_labels(), loc="outside upper right", ncols=2)
    _draw_levels(envelope, spectrum, diagnosis)
    figure.align_ylabels()
    return figure


def _shown(diagnosis: Diagnosis, spectrum: BandSpectrum, recording: Recorded) -> DrawnRecord:
    """Channel whose spectrum is shown, at the speed of the diagnosis."""
    signal, band = recording.used.signals[spectrum.channel], Band(*spectrum.band)
    return DrawnRecord("", signal, recording.fs, diagnosis.shaft_rate, diagnosis.orders, HEALTHY, band, recording.unit)


def _levels(spectrum: BandSpectrum, shaft_rate: float) -> tuple[FloatArray, FloatArray]:
    """Orders, without 0, and levels over the floor [dB] of an envelope spectrum."""
    order = np.arange(1, len(spectrum.ratio)) * spectrum.resolution / shaft_rate
    return order, 10 * np.log10(np.maximum(spectrum.ratio[1:], 1e-3))


def _draw_levels(axes: Axes, spectrum: BandSpectrum, diagnosis: Diagnosis) -> None:
    """Level of the envelope spectrum over its floor, with the lines of each family, and the evidence marked."""
    order, level = _levels(spectrum, diagnosis.shaft_rate)
    # the first harmonics of each family by its class; of those without a comb the first alone
    lines_of = {
        row.name: [
            float(row.lines[0].order(diagnosis.orders)) * n
            for n in range(1, DRAWN_HARMONICS + 1 if row.name in COMBS else 2)
        ]
        for row in families()
    }
    # some harmonics of the highest family, as far as the spectrum goes
    top = min(order[-1], (DRAWN_HARMONICS + 0.15) * max(lines[0] for lines in lines_of.values()))
    visible = order <= top
    names: dict[str, float] = {SHAFT.label: 1.0}
    for fault, lines in lines_of.items():
        for number, line in enumerate(lines):
            axes.axvline(
                line,
                color=FAULT_COLOURS[fault],
                linewidth=1.0,
                alpha=0.65,
                linestyle="-" if number == 0 else (0, (3, 3)),
            )
        names[fault_class(fault).lines[0].label] = lines[0]
    axes.axvline(1.0, color=FAINT, linewidth=0.7, linestyle=(0, (2, 2)))
    axes.plot(order[visible], level[visible], color=INK, linewidth=0.7)
    axes.axhline(LEAST_LEVEL, color=FAINT, linewidth=0.7, linestyle=(0, (4, 3)))
    shown = (spectrum.band, spectrum.channel)
    # evidence of other bands or channels would not stand on this curve
    marked = [line for line in diagnosis.evidence if (line.band, line.channel) == shown and line.order <= top]
    for line in marked:
        marker = "o" if not line.side else "s"
        axes.plot(line.order, line.level, marker, color=FAULT_COLOURS[line.fault], markersize=4 if line.side else 6)
    highest = max(float(level[visible].max(initial=LEAST_LEVEL)), LEAST_LEVEL)
    axes.set(
        xlabel="order of the shaft",
        ylabel="level over the floor [dB]",
        xlim=(0, top),
        ylim=(LOWEST_DB, highest + MARGIN_DB),
    )
    name_lines(axes, {}, names, INK, top)
    low, high = (f"{from_si(edge, 'khz'):.3g}" for edge in spectrum.band)
    axes.set_title(f"Envelope spectrum of {low}-{high} kHz over its floor; dots mark the evidence", pad=30)
