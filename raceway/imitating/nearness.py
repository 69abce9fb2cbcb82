"""How near the healthy records of a recipe are to the recordings that it imitates: AUC of each measure, and a page."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from features.signal.rows import FloatArray
from features.signal.spectra import psd
from gen.corpus.fault_classes import HEALTHY
from gen.generation.memory import simulate
from gen.generation.writing import write_corpus
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.support.units import from_si
from raceway.comparing import compare
from raceway.comparing.comparison import FEWEST, TOP
from raceway.comparing.measures import MEASURES
from raceway.reports.pictures import (
    SEGMENT,
    STYLE,
    WIDTH,
    DrawnRecord,
    draw_density,
    draw_envelope_spectrum,
    draw_waveform,
    picture,
    squared_envelope,
)
from raceway.reports.subject import shown_of
from raceway.reports.templates import write_page

RECORDS, DRAWN = 40, 10


def write_nearness(recipe: Recipe, segments: FloatArray, recorded: Path, page: Path) -> dict[str, float | None]:
    """AUC of each measure between a corpus of recordings and healthy records of a recipe, which are shown on a ``page``.

    ``segments`` of the recordings have the shape (segment, time) [m s-2].

    Raises
    ------
    CorpusError, SimulationError
        If no record can be simulated, or the page cannot be written.
    """
    drawn = draw_scenarios(recipe, 0, min(recipe.n_records, RECORDS * recipe.corpus.n_rungs))
    records = simulate([scenario for scenario in drawn if scenario.fault == HEALTHY])
    # a short recording is compared in shorter windows
    fewest = min(len(segments), records.sizes["record"])
    window = recipe.recording.duration_s / math.ceil(FEWEST / fewest)
    made = write_corpus(records, recorded.with_name("records.nc"))
    top = min(TOP, 0.4 * recipe.recording.sample_rate_hz)
    auc = compare(made, [recorded], top=top, window=window).auc[HEALTHY]
    shown = [shown_of(records.isel(record=number), number, 0, named=False) for number in range(min(DRAWN, fewest))]
    write_page(
        page,
        "nearness.html.jinja",
        "raceway.imitating",
        recipe=recipe,
        picture=picture(
            draw_nearness([each._replace(signal=x) for each, x in zip(shown, segments, strict=False)], shown), "svg"
        ),
        rows=[(measure, auc[measure.name]) for measure in MEASURES if measure.name in auc],
        window=window,
    )
    return auc


@rc_context(STYLE)
def draw_nearness(segments: list[DrawnRecord], records: list[DrawnRecord]) -> Figure:
    """Waveform of a recording and of a record; density and envelope spectrum of the recording over the band of all records."""
    figure = Figure(figsize=(WIDTH, 7.5), layout="constrained")
    first, second, density, envelope = figure.subplots(4, 1, height_ratios=(1, 1, 1.2, 1.2))
    look: Any = {"color": "#009E73", "label": f"{len(records)} healthy records of the recipe"}
    draw_waveform(first, segments[0])
    draw_waveform(second, records[0])
    second.lines[0].set(color=look["color"])
    second.sharey(first)
    densities = [psd(each.signal[None], each.fs, SEGMENT) for each in records]
    levels = [(from_si(frequency, "khz"), 10 * np.log10(power[0])) for frequency, power in densities]
    for axes, draw, curves in (
        (density, draw_density, levels),
        (envelope, draw_envelope_spectrum, [*map(squared_envelope, records)]),
    ):
        draw(axes, segments[0])
        values = np.stack([curve for _, curve in curves])
        axes.fill_between(curves[0][0], values.min(axis=0), values.max(axis=0), alpha=0.4, linewidth=0, **look)
        axes.autoscale(axis="y")
    envelope.set_ylim(bottom=0)
    figure.legend(*density.get_legend_handles_labels(), loc="outside lower right", ncols=2)
    return figure
