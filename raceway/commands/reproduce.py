"""``raceway reproduce``: a page of the seed paper."""

import math
from pathlib import Path

import click

from raceway.console import show
from raceway.console.options import json_option, pages_option


@click.group()
def reproduce() -> None:
    """Run the seed paper again.

    raceway reproduce ophel2025 -o ophel
    """


@reproduce.command()
@pages_option("OUT", "Folder for ophel2025.html and findings.json.")
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

    Writes a page with the figures of the paper, each beside the values that it prints, and its statements measured,
    with three parameter sets: paper was fitted freely; paper-hertz has the contact stiffness of the geometry, and a
    load close to the weight of the rotor; paper-refit has that stiffness and exactly that weight. For each statement
    that does not hold, the page has the reason and the one constant with which it holds; --change repeats that
    experiment, and docs/model.md explains it.

      raceway reproduce ophel2025 -o ophel
      raceway reproduce ophel2025 --preset paper --change support_damping_y=4500 -o damped
    """
    from raceway.studies.experiments import changed
    from raceway.studies.paper import PRESETS
    from raceway.studies.paper_page import write_paper_page

    if preset is not None and preset not in PRESETS:
        raise click.BadParameter(f"{preset} is none of {', '.join(PRESETS)}", param_hint="'--preset'")
    change = _constants(changes)
    chosen = {name: constants for name, constants in PRESETS.items() if preset in (None, name)}
    if change:
        chosen = {f"{name}-changed": changed(constants, change) for name, constants in chosen.items()}
    page, findings = write_paper_page(output, chosen)
    if as_json:
        show.as_json({"page": page, "findings": [finding.facts() for finding in findings]})
        return
    for name in chosen:
        holds = [finding.holds for finding in findings if finding.preset == name]
        show.text(f"{name}: {sum(holds)} of {len(holds)} statements hold.")
    show.text(f"{page}: its figures and statements.")


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
