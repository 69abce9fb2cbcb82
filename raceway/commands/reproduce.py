"""``raceway reproduce``: the seed paper run again, its figures drawn and its statements measured."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show
from raceway.console.options import folder_option, json_option

if TYPE_CHECKING:
    from raceway.studies.paper import Run

FIGURES = (
    ("figure3", "Healthy: displacements", "healthy", False),
    ("figure4", "Healthy: power spectra", "healthy", True),
    ("figure5", "Cracked inner race: displacements", "cracked", False),
    ("figure6", "Cracked inner race: power spectra", "cracked", True),
)
_CHANNELS = ("shaft, x1", "shaft, y1", "housing, x2", "housing, y2")


@click.command()
@click.argument("paper", type=click.Choice(["ophel2025"]))
@folder_option("OUT", "Folder for the figures and findings.json.")
@json_option
def reproduce(paper: str, output: Path, as_json: bool) -> None:  # noqa: ARG001 - there is one paper so far
    """Run the seed paper again.

    Its figures are drawn, and what it states is measured. Three parameter sets: paper is the first that was found;
    paper-hertz keeps the contact stiffness that follows from the geometry and about the weight of the rotor as load; paper-refit keeps
    both and lets most statements hold. Where one does not, the table says why; docs/errata.md has the reasons at length.

      raceway reproduce ophel2025 -o ophel
    """
    from features.report.pictures import picture
    from gen.corpus import write_durably, write_text_durably
    from raceway.studies.paper import PRESETS, findings, run

    output.mkdir(parents=True, exist_ok=True)
    found = []
    for name, preset in PRESETS.items():
        made = run(preset)
        found += findings(name, made)
        for number, title, state, spectral in FIGURES:
            figure = draw_figure(made, state, spectral, f"{title}, preset {name}")
            write_durably(picture(figure, "png"), output / f"{name}-{number}.png")
    table = {"findings": [finding._asdict() for finding in found]}
    write_text_durably(show.json_text(table), output / "findings.json")
    if as_json:
        show.as_json(table)
        return
    header = ("finding", "preset", "statement", "value", "accepted", "holds")
    show.table(
        header,
        [(f.id, f.preset, f.finding, f"{f.value:.4g}", span(f.accept), "yes" if f.holds else "NO") for f in found],
    )
    show.text("", "Displacements in thousandths of a millimetre. What does not hold:")
    show.definitions({f"{f.preset} {f.id}": f.why for f in found if not f.holds})
    for name in PRESETS:
        mine = [f for f in found if f.preset == name]
        show.text(f"{name}: {sum(f.holds for f in mine)} of {len(mine)} statements hold.")


def span(accept: tuple[float, float]) -> str:
    """Accepted range, in words."""
    low, high = accept
    return f"over {low:g}" if high == float("inf") else f"{low:g} to {high:g}"


def draw_figure(made: "Run", state: str, spectral: bool, title: str) -> Any:
    """One figure of the paper: four channels, over time or over frequency."""
    import numpy as np
    from matplotlib.figure import Figure

    from raceway.studies.paper import FS, power_spectrum

    signal = getattr(made, state)
    figure = Figure(figsize=(9, 6), layout="constrained")
    figure.suptitle(title)
    for axes, name, x in zip(figure.subplots(2, 2).flat, _CHANNELS, signal, strict=True):
        if spectral:
            frequency, power = power_spectrum(x)
            axes.semilogy(frequency[1:1001], power[1:1001], color="black", linewidth=0.7)
            axes.set(xlabel="frequency [Hz]", ylabel="power [µm²]")
        else:
            shown = slice(None, round((0.3 if state == "healthy" else 1.0) * FS))
            axes.plot(np.arange(len(x))[shown] / FS, x[shown], color="black", linewidth=0.7)
            axes.set(xlabel="time [s]", ylabel="displacement [µm]")
        axes.set_title(name, loc="left", fontsize=10)
        axes.spines[["top", "right"]].set_visible(False)
    return figure
