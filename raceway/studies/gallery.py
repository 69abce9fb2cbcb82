"""The gallery: one page of pictures of simulated signals.

It shows the seed paper's figures beside its statements, every kind of fault, run-ups, and faults of the measuring chain.
"""

from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from features.indicators import Orders
from features.report.envelopes import draw_envelopes, draw_waterfall
from features.report.pictures import Shown, fault_lines, picture
from gen import generate, open_corpus
from gen.corpus import FAULTS, make_result_folder, write_durably, write_text_durably
from gen.physics.profile import share_at
from gen.scenarios import Specimen, read_scenario
from raceway.console.progress import progress
from raceway.studies.orbits import draw_orbits
from raceway.studies.paper import FIGURES, PRESETS, draw_figures, run
from raceway.studies.schematics import draw_schematics
from raceway.studies.sensor_faults import write_sensor_fault_pictures
from raceway.studies.statements import Finding, findings, span

_STATES = {"healthy": "H", "cracked": "C"}  # state of the bearing, and first letter of the paper's statements about it

_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="generator" content="Raceway">
<meta name="viewport" content="width=device-width"><title>Raceway: gallery</title>
<style>
body {{ font: 15px/1.5 sans-serif; color: #222; max-width: 66rem; margin: 2rem auto; padding: 0 1rem }}
img {{ max-width: 100%; display: block; margin: 1rem 0 }}
table {{ border-collapse: collapse; font-size: 13px }}
td, th {{ padding: .1rem .8rem .1rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid #ddd }}
.pair {{ display: grid; grid-template-columns: repeat(auto-fit, minmax(24rem, 1fr)); gap: 1rem }}
</style>
<h1>What Raceway makes</h1>
{sections}
</html>
"""


class Section(NamedTuple):
    """One section of the page."""

    title: str
    text: str
    pictures: list[str]
    """File names."""
    table: str = ""
    """HTML."""


def write_gallery(output: Path) -> tuple[Path, list[Path]]:
    """Write the page, its pictures and the two corpora that they show into a folder; returns the page and the pictures."""
    make_result_folder(output)
    sections = [*_paper(output), _every_fault(output), _run_up(output), _orbits(output), _sensor_faults(output)]
    page = output / "index.html"
    write_text_durably(_PAGE.format(sections="\n".join(map(_html, sections))), page)
    return page, [output / name for section in sections for name in section.pictures]


def _html(section: Section) -> str:
    title = escape(section.title)
    images = "".join(f'<img src="{escape(name)}" alt="{title}">' for name in section.pictures)
    if section.table:
        body = f'<div class="pair"><div>{images}</div><div>{section.table}</div></div>'
    else:
        body = images if len(section.pictures) == 1 else f'<div class="pair">{images}</div>'
    return f"<h2>{title}</h2>\n<p>{escape(section.text)}</p>\n{body}"


def _paper(output: Path) -> Iterator[Section]:
    """Figures 1 to 6 of the seed paper; 3 to 6 beside its statements about them."""
    preset = PRESETS["paper"]
    made = run(preset)
    statements = findings("paper", made)
    for name, drawn in (*draw_schematics(preset), *draw_figures(made)):
        write_durably(picture(drawn, "png"), output / f"{name}.png")
    text = "The system of the seed paper with the constants of preset paper, and its bearing with the crack. Drawn anew, not copied."
    yield Section("Ophel et al., the system", text, ["figure1.png", "figure2.png"])
    for state, letter in _STATES.items():
        names = [f"{figure}.png" for figure, _, shown, _ in FIGURES if shown == state]
        table = _findings_table([finding for finding in statements if finding.id.startswith(letter)])
        text = (
            "Preset paper of the seed paper, displacements in thousandths of a millimetre, and the paper's statements. "
            "Beside a statement that does not hold stands the change of the preset with which it holds."
        )
        yield Section(f"Ophel et al., {state}", text, names, table)


def _findings_table(statements: list[Finding]) -> str:
    cells = [("", "statement", "value", "accepted", "holds")]
    cells += [
        (f.id, f.finding, f"{f.value:.4g}", span(f.accept), "yes" if f.holds else f"no: {f.reason}") for f in statements
    ]
    rows = ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in cells]
    return "<table>" + "".join(f"<tr>{row}</tr>" for row in rows) + "</table>"


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
