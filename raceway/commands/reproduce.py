"""``raceway reproduce``: run the seed paper again, draw its figures and measure its statements."""

from pathlib import Path

import click

from raceway.console import show
from raceway.console.options import folder_option, json_option


@click.command()
@click.argument("paper", type=click.Choice(["ophel2025"]))
@folder_option("OUT", "Folder for the figures and findings.json.")
@json_option
def reproduce(paper: str, output: Path, as_json: bool) -> None:  # noqa: ARG001 - there is one paper so far
    """Run the seed paper again.

    Draws its figures and measures its statements, with three parameter sets: paper is the first one that was found; paper-hertz has the
    contact stiffness of the geometry, and a load close to the weight of the rotor; with paper-refit, which has that stiffness and that
    weight, most statements hold. The table gives the reason why a statement does not hold; docs/errata.md explains it.

      raceway reproduce ophel2025 -o ophel
    """
    from raceway.studies.statements import reproduced, span

    found = reproduced(output)
    if as_json:
        show.as_json({"findings": [finding._asdict() for finding in found]})
        return
    header = ("finding", "preset", "statement", "value", "accepted", "holds")
    show.table(
        header,
        [(f.id, f.preset, f.finding, f"{f.value:.4g}", span(f.accept), "yes" if f.holds else "NO") for f in found],
    )
    show.text("", "Displacements in thousandths of a millimetre. Statements that do not hold:")
    show.definitions({f"{f.preset} {f.id}": f.why for f in found if not f.holds})
    for name in dict.fromkeys(f.preset for f in found):
        mine = [f for f in found if f.preset == name]
        show.text(f"{name}: {sum(f.holds for f in mine)} of {len(mine)} statements hold.")
