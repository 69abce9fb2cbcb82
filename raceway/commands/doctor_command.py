"""A command about this installation."""

import platform
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, requires, version

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.options import json_option

EXTRAS = ("files", "parquet")
"""Optional requirements for users; the others are for developers."""


@click.command()
@json_option
def doctor(as_json: bool) -> int:
    """Show installed versions and plug-ins.

    Exits with 1 if a package that Raceway needs is missing or too old, or a plug-in cannot be loaded; a line that begins with "note" is of
    an optional package.

      raceway doctor
      raceway doctor --json
    """
    facts = list(_findings())
    problems = sum(fact["state"] == "problem" for fact in facts)
    if as_json:
        show.as_json({"problems": problems, "findings": facts})
    else:
        for row in facts:
            advice = f"; {row['advice']}" if row["advice"] else ""
            show.text(f"{row['state'].ljust(7)}  {row['subject']}: {row['value']}{advice}")
        wanting = f"{show.count_text(problems, 'problem')}."
        show.text("", wanting if problems else "Everything that Raceway needs is installed.")
    return FOUND_WANTING if problems else DONE


def _findings() -> Iterator[dict[str, str]]:
    """Versions of Python, Raceway and its requirements; the state of each, and advice where it is not ``fine``."""
    from packaging.requirements import Requirement

    from gen.support.plugins import GROUPS, distribution, plugins  # not at the top: help needs nothing of gen

    yield _finding("Python", f"{platform.python_version()} ({sys.executable})")
    yield _finding("raceway", version("raceway"))
    # extras that nobody asked for may be missing, and two of them may need one library
    wanted = {
        needed.name: needed
        for needed in map(Requirement, requires("raceway") or ())
        if needed.marker is None or any(needed.marker.evaluate({"extra": extra}) for extra in EXTRAS)
    }
    for needed in wanted.values():
        try:
            present = version(needed.name)
            is_met = needed.specifier.contains(present, prereleases=True)
        except PackageNotFoundError:
            present, is_met = "missing", False
        advice = "" if is_met else f"pip install '{str(needed).partition(';')[0].strip()}'."
        yield _finding(needed.name, present, "fine" if is_met else "note" if needed.marker else "problem", advice)
    for group in GROUPS:
        for name, entry in plugins(group).items():
            try:
                entry.load()
                state, advice = "fine", ""
            except Exception as error:  # noqa: BLE001 - code of other people
                state, advice = "problem", f"{type(error).__name__}: {error}; correct it, or uninstall it."
            yield _finding(f"plug-in {name}", f"raceway.{group} of {distribution(entry)}", state, advice)


def _finding(subject: str, value: str, state: str = "fine", advice: str = "") -> dict[str, str]:
    return {"subject": subject, "value": value, "state": state, "advice": advice}
