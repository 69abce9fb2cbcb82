"""The page of the seed paper: ``python -m studies.ophel2025 -o OUT``."""

import math
import sys
from collections.abc import Sequence
from pathlib import Path

import click

from raceway.console import show
from raceway.console.ending import exit_code
from raceway.console.options import pages_option
from studies.ophel2025.experiments import UNITS, changed
from studies.ophel2025.page import write_page
from studies.ophel2025.paper import PRESETS


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@pages_option("OUT", "Folder for ophel2025.html and findings.json.")
@click.option("--preset", type=click.Choice(list(PRESETS)), help="Run this set of constants only.")
@click.option(
    "--change", "changes", multiple=True, metavar="CONSTANT=VALUE", help="Replace a constant, in SI units; repeatable."
)
def reproduce(output: Path, preset: str | None, changes: tuple[str, ...]) -> None:
    """Run the systems of the seed paper, and write its figures and statements on one page.

    For each statement that does not hold, the page has the reason and the one constant with which it holds; --change
    repeats that experiment. errata.md beside this file explains the sets of constants.
    """
    change = _constants(changes)
    chosen = {name: constants for name, constants in PRESETS.items() if preset in (None, name)}
    if change:
        chosen = {f"{name}-changed": changed(constants, change) for name, constants in chosen.items()}
    page, findings = write_page(output, chosen)
    for name in chosen:
        holds = [finding.holds for finding in findings if finding.preset == name]
        show.text(f"{name}: {sum(holds)} of {len(holds)} statements hold.")
    show.text(f"{page}: its figures and statements.")


def _constants(changes: tuple[str, ...]) -> dict[str, float]:
    """Names and values of ``--change``."""
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


def main(arguments: Sequence[str]) -> int:
    """Run the command; returns its exit code."""
    name = "python -m studies.ophel2025"
    return exit_code(lambda: reproduce.main(list(arguments), name, standalone_mode=False))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
