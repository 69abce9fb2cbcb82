"""Page of the seed paper: its figures and statements with every preset side by side, in one HTML file."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gen.corpus import make_result_folder, write_numbers, write_text_durably
from raceway.console.show import plain
from raceway.reports.pictures import BLUE, STYLE, picture
from raceway.reports.templates import template
from studies.ophel2025.experiments import UNITS, constant
from studies.ophel2025.paper import CHANNELS, FIGURES, FS, PRESETS, Preset, Run, power_spectrum, run_many
from studies.ophel2025.schematics import draw_crack, draw_model
from studies.ophel2025.statements import STATEMENTS, Finding, findings, span

SHOWN_S = 0.3  # s of the displacements drawn; a whole second would be one black band
SHOWN_HZ = 1000
FAINTEST = 1e-7  # power drawn, below the highest
WIDTH, HEIGHT = 4.0, 7.6  # inches: three pictures side by side on a screen, one on a phone


def write_page(folder: Path, presets: Mapping[str, Preset] = PRESETS) -> tuple[Path, list[Finding]]:
    """Write ``ophel2025.html`` and ``findings.json`` into a folder; returns the page and all measured statements.

    Raises
    ------
    SimulationError
        If a system leaves the finite range.
    """
    runs = dict(zip(presets, run_many(list(presets.values())), strict=True))
    measured = {name: findings(name, run) for name, run in runs.items()}
    page = template("ophel2025.html.jinja", "studies.ophel2025").render(
        amended=sum(bool(statement.amended) for statement in STATEMENTS.values()),
        counts={name: _counts(of_preset) for name, of_preset in measured.items()},
        constants={name: [f"{constant(preset, name):.4g}" for preset in presets.values()] for name in UNITS},
        units=UNITS,
        schematics=[
            (drawn.get_suptitle(), picture(drawn, "svg"))
            for drawn in (draw_model(next(iter(presets.values()))), draw_crack())
        ],
        figures=[
            (title, _pictures(name, runs), _rows(name, measured), _reasons(name, measured))
            for name, (title, _, _) in FIGURES.items()
        ],
        span=span,
    )
    every = [finding for of_preset in measured.values() for finding in of_preset]
    make_result_folder(folder)
    write_text_durably(page, folder / "ophel2025.html")
    write_numbers(plain({"findings": [finding.facts() for finding in every]}), folder / "findings.json")
    return folder / "ophel2025.html", every


def _counts(of_preset: list[Finding]) -> list[tuple[int, int]]:
    """Number of the statements that hold and of all, of those that the constants were fitted to and of the others."""
    groups = [[finding.holds for finding in of_preset if finding.fitted is fitted] for fitted in (True, False)]
    return [(sum(group), len(group)) for group in groups]


def _rows(figure: str, measured: Mapping[str, list[Finding]]) -> list[tuple[Finding, ...]]:
    """A statement about the figure with every preset in each row."""
    return [row for row in zip(*measured.values(), strict=True) if row[0].statement.figure == figure]


def _reasons(figure: str, measured: Mapping[str, list[Finding]]) -> list[Finding]:
    return [curve for row in _rows(figure, measured) for curve in row if curve.reason]


def _pictures(name: str, runs: Mapping[str, Run]) -> dict[str, bytes]:
    """One figure of the paper with every preset; each channel has the same scale in all."""
    drawn = {preset: draw_figure(name, run) for preset, run in runs.items()}
    for panels in zip(*(figure.axes for figure in drawn.values()), strict=True):
        limits = [axes.get_ylim() for axes in panels]
        for axes in panels:
            axes.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
    return {preset: picture(figure, "png") for preset, figure in drawn.items()}


@rc_context(STYLE)
def draw_figure(name: str, run: Run) -> Figure:
    """Draw one figure of the paper, a channel in each panel, with the values that the paper prints."""
    _, state, spectral = FIGURES[name]
    figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
    for axes, channel, x in zip(figure.subplots(4, sharex=True), CHANNELS, getattr(run, state), strict=True):
        if spectral:
            frequency, power = (some[..., 1 : SHOWN_HZ + 1] for some in power_spectrum(x))
            axes.semilogy(frequency, power, color="black", linewidth=0.7)
            axes.set_ylim(FAINTEST * power.max(), 10 * power.max())
        else:
            shown = x[: round(SHOWN_S * FS)]
            axes.plot(np.arange(len(shown)) / FS, shown, color="black", linewidth=0.5)
        axes.set_title(f"{'housing' if channel[1] == '2' else 'shaft'}, {channel}", pad=27 if spectral else None)
        axes.set_ylabel("power [µm²]" if spectral else "displacement [µm]")
        _draw_printed(axes, name, channel, spectral)
    figure.axes[-1].set_xlabel("frequency [Hz]" if spectral else "time [s]")
    return figure


def _draw_printed(axes: Axes, figure: str, channel: str, spectral: bool) -> None:
    """Values and bands that the paper prints for a channel."""
    about = [
        statement
        for statement in STATEMENTS.values()
        if (statement.figure, statement.channel) == (figure, channel) and statement.printed
    ]
    for values in dict.fromkeys(statement.printed for statement in about):
        text = "–".join(f"{value:g}" for value in values)
        if not spectral:
            axes.axhline(values[0], color=BLUE, linestyle="--", linewidth=1)
            axes.text(1.01, values[0], text, color=BLUE, va="center", transform=axes.get_yaxis_transform())
            continue
        if len(values) > 1:
            axes.axvspan(*values, color=BLUE, alpha=0.15, linewidth=0)
        else:
            axes.axvline(max(values), color=BLUE, linestyle="--", linewidth=1)
        above = 2 if len(values) == 1 else 12  # points: bands have a row of their own
        axes.annotate(
            text, (sum(values) / len(values), 1), (0, above), ("data", "axes fraction"), "offset points",
            color=BLUE, ha="center", va="bottom", annotation_clip=False,
        )  # fmt: skip
