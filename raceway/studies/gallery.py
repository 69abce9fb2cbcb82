"""The gallery: one page of pictures of simulated signals.

It shows every kind of fault, run-ups, and faults of the measuring chain, and links to the page of the seed paper.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from features.indicators import Orders
from features.report.envelopes import draw_envelopes, draw_waterfall
from features.report.pictures import Shown, fault_lines, picture
from features.report.templates import template
from gen import generate, open_corpus
from gen.corpus import FAULTS, make_result_folder, write_durably, write_text_durably
from gen.physics.profile import share_at
from gen.scenarios import Specimen, read_scenario
from raceway.console.progress import progress
from raceway.studies.orbits import draw_orbits
from raceway.studies.paper_page import write_paper_page
from raceway.studies.sensor_faults import write_sensor_fault_pictures


class Section(NamedTuple):
    """One section of the page."""

    title: str
    text: str
    pictures: list[str]
    """File names."""


def write_gallery(output: Path) -> tuple[Path, list[Path]]:
    """Write the page, its pictures and the two corpora that they show into a folder; returns the page and the pictures."""
    make_result_folder(output)
    sections = [_every_fault(output), _run_up(output), _orbits(output), _sensor_faults(output)]
    write_paper_page(output)
    page = output / "index.html"
    write_text_durably(template("gallery.html.jinja", "raceway.studies").render(sections=sections), page)
    return page, [output / name for section in sections for name in section.pictures]


def _every_fault(output: Path) -> Section:
    """Envelope spectrum of one specimen of every kind of fault."""
    corpus = _corpus("every_fault", output)
    kinds: dict[str, int] = {}
    for record, draws in enumerate(corpus["draws"].values):
        kinds.setdefault(_damage_text(read_scenario(str(draws)).specimen), record)
    shown = [
        _shown(corpus.isel(record=record), kind)
        for kind, record in sorted(kinds.items(), key=lambda item: _rank(corpus, item[1]))
    ]
    write_durably(picture(draw_envelopes(shown), "png"), output / "envelopes.png")
    text = (
        "A 6205 at 1797 rpm, one specimen of each kind. The lines of its own fault are shaded, those of other faults dotted. The vibration "
        "of a worn race lies below the frequency band of this envelope, so its spectrum shows no lines."
    )
    return Section("Every fault", text, ["envelopes.png"])


def _rank(corpus: xr.Dataset, record: int) -> tuple[int, int]:
    return int(corpus["fault"][record]), record


def _damage_text(specimen: Specimen) -> str:
    """Damage of a specimen in a few words."""
    if specimen.wear is not None:
        return f"{specimen.wear.site} race worn all round"
    more = [", traced" if spall.trace else ", rough floor" if spall.roughness > 0 else "" for spall in specimen.spalls]
    words = [f"{spall.site} {1e3 * spall.width:g} mm{text}" for spall, text in zip(specimen.spalls, more, strict=True)]
    wander = ", axis wanders" if specimen.axis.get("axis_wander", 0) > 0 else ""
    return (" + ".join(words) or ("cage" if specimen.cage else "healthy")) + wander


def _shown(record: xr.Dataset, title: str) -> Shown:
    orders = Orders(*(record[name].values for name in Orders._fields))
    signal = record["acceleration"].values[0].astype(float)
    return Shown(
        title, signal, float(record["sample_rate"]), float(record["shaft_rate"]), orders, FAULTS[int(record["fault"])]
    )


def _run_up(output: Path) -> Section:
    """Waterfall of one record of each class."""
    corpus = _corpus("run_up", output)
    names = []
    for fault in np.unique(corpus["fault"].values):
        record = corpus.isel(record=int(np.flatnonzero(corpus["fault"].values == fault)[0]))
        shown, drawn = _shown(record, FAULTS[fault]), read_scenario(str(record["draws"].values)).record
        times = np.arange(len(shown.signal)) / shown.fs
        share = 1.0 if drawn.speed_profile is None else share_at(drawn.speed_profile, times)
        rate = drawn.conditions.shaft_rate * share * np.ones(len(times))
        figure = draw_waterfall(
            f"Run-up: {shown.fault}", shown.signal, shown.fs, (2000.0, 5000.0), rate, _marked_orders(shown)
        )
        names.append(f"run-up-{shown.fault}.png")
        write_durably(picture(figure, "png"), output / names[-1])
    text = "From 600 to 3000 rpm in nine seconds. Broken lines: orders of the shaft at its speed at that time."
    return Section("Run-ups", text, names)


def _orbits(output: Path) -> Section:
    write_durably(picture(draw_orbits(), "png"), output / "orbits.png")
    text = (
        "Each harmonic of the shaft moves the machine along an ellipse, so two crossed sensors have a phase of their own at each. Averaged "
        "over the turns of the true shaft angle, although the speed wanders by 1 %. A part of the noise is common to both."
    )
    return Section("Two sensors on one machine", text, ["orbits.png"])


def _sensor_faults(output: Path) -> Section:
    """Every sensor fault, and a gear, beside the record without it."""
    text = (
        "Records of recipe dirty_sensors with one fault of the measuring chain each, and with the gear of the machine."
    )
    return Section("Sensor faults and a gear", text, write_sensor_fault_pictures(output))


def _marked_orders(shown: Shown) -> dict[str, float]:
    """Orders drawn into a waterfall: the shaft and the first two lines of the fault, or of a healthy bearing all fundamental lines."""
    own, others = fault_lines(shown.orders, shown.fault)
    return {"shaft": 1.0, **dict(list(own.items())[:2])} if own else others


def _corpus(recipe: str, output: Path) -> xr.Dataset:
    with progress(f"generating {recipe}", "records") as report:
        generate(recipe, output / recipe, progress=report)
    return open_corpus(output / recipe)
