"""A command about this machine and installation."""

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.options import json_option


@click.command()
@json_option
def doctor(as_json: bool) -> int:
    """Show what this machine and installation can do.

    Versions, cores, memory and disk, compiled kernels, codecs, optional packages, readers of other projects, and the speed of the kernel
    against the published figure; with advice where something is missing or amiss. Takes some seconds.

    Exits with 1 if something that Raceway needs is missing; a line that begins with "note" is no fault.

      raceway doctor
      raceway doctor --json
    """
    from raceway.studies.doctor import findings

    found = []
    for one in findings():
        found.append(one)
        if not as_json:
            show.text(f"{one.state.ljust(7)}  {one.subject}: {one.found}{f'; {one.advice}' if one.advice else ''}")
    problems = sum(one.state == "problem" for one in found)
    if as_json:
        show.as_json({"problems": problems, "findings": [one._asdict() for one in found]})
    else:
        show.text(
            "", "Everything that Raceway needs is here." if not problems else f"{show.counted(problems, 'problem')}."
        )
    return FOUND_WANTING if problems else DONE
