"""``raceway reproduce``: the figures and statements of the seed paper, and a page of pictures of simulated signals."""

import math
import time
from pathlib import Path

import click

from raceway.console import show
from raceway.console.options import json_option, pages_option
from raceway.console.progress import notice_compilation


@click.group()
def reproduce() -> None:
    """Run the seed paper again, or draw a gallery of signals.

    Both write pages and pictures into a folder; docs/errata.md and docs/model.md explain them.

      raceway reproduce ophel2025 -o ophel
      raceway reproduce gallery -o gallery
    """


@reproduce.command()
@pages_option("OUT", "Folder for the figures and findings.json.")
@click.option("--preset", metavar="NAME", help="Run this parameter set only.")
@click.option(
    "--change", "changes", multiple=True, metavar="CONSTANT=VALUE", help="Replace a constant, in SI units; repeatable."
)
@json_option
def ophel2025(
    output: Path,
    preset: str | None,
    changes: tuple[str, ...],
    as_json: bool,
) -> None:
    """Run the seed paper again.

    Draws its figures and measures its statements, with three parameter sets: paper is the first one that was found; paper-hertz has the
    contact stiffness of the geometry, and a load close to the weight of the rotor; paper-refit has that stiffness and exactly that
    weight. Under the table stands, for each statement that does not hold, the reason and the one constant with which it holds;
    --change repeats that experiment, and docs/errata.md explains it.

      raceway reproduce ophel2025 -o ophel
      raceway reproduce ophel2025 --preset paper --change support_damping_y=4500 -o damped
    """
    from raceway.studies.experiments import changed
    from raceway.studies.paper import PRESETS
    from raceway.studies.statements import reproduce, span

    if preset is not None and preset not in PRESETS:
        raise click.BadParameter(f"{preset} is none of {', '.join(PRESETS)}", param_hint="'--preset'")
    change = _constants(changes)
    chosen = {name: constants for name, constants in PRESETS.items() if preset in (None, name)}
    if change:
        chosen = {f"{name}-changed": changed(constants, change) for name, constants in chosen.items()}
    findings = reproduce(output, chosen)
    if as_json:
        show.as_json({"findings": [finding._asdict() for finding in findings]})
        return
    header = ("finding", "preset", "statement", "value", "accepted", "holds")
    show.table(
        header,
        [(f.id, f.preset, f.finding, f"{f.value:.4g}", span(f.accept), "yes" if f.holds else "NO") for f in findings],
    )
    show.text("", "Displacements in thousandths of a millimetre.")
    reasons = {f"{f.preset} {f.id}": f.reason for f in findings if f.reason}
    if reasons:
        show.text("Statements that do not hold, and the change with which each holds:")
        show.definitions(reasons)
    for name in dict.fromkeys(f.preset for f in findings):
        mine = [f for f in findings if f.preset == name]
        fitted = [f for f in mine if f.fitted]
        show.text(
            f"{name}: {sum(f.holds for f in mine)} of {len(mine)} statements hold.",
            f"  Of the {len(fitted)} that its constants were fitted to, {sum(f.holds for f in fitted)} hold.",
        )


@reproduce.command()
@pages_option("OUT", "Folder for index.html, its pictures, and the two small corpora they show.")
@json_option
def gallery(output: Path, as_json: bool) -> None:
    """Draw one page of simulated signals.

    The page has the seed paper's figures beside its statements, the envelope spectrum of every kind of fault (recipe every_fault), run-ups
    as waterfalls with the shaft orders drawn in (recipe run_up), and every fault of the measuring chain (recipe dirty_sensors).

      raceway reproduce gallery -o gallery
    """
    from raceway.studies.gallery import write_gallery

    start = time.monotonic()
    with notice_compilation():
        page, pictures = write_gallery(output)
    if as_json:
        show.as_json({"page": page, "pictures": pictures})
        return
    show.text(f"{page}: {show.count_text(len(pictures), 'picture')}, in {show.duration(time.monotonic() - start)}.")


def _constants(changes: tuple[str, ...]) -> dict[str, float]:
    """Names and values of ``--change``."""
    from raceway.studies.experiments import UNITS

    constants = {}
    for change in changes:
        name, _, written = change.partition("=")
        if name not in UNITS:
            raise click.BadParameter(f"{name!r} is none of {', '.join(UNITS)}", param_hint="'--change'")
        try:
            constants[name] = float(written)
        except ValueError:
            constants[name] = math.nan
        if not math.isfinite(constants[name]) or (name in ("housing_mass", "shaft_rate") and constants[name] <= 0):
            raise click.BadParameter(
                f"{change}: give a number, above zero for a mass or a rate", param_hint="'--change'"
            )
    return constants
