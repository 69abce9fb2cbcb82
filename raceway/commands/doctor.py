"""A command about this installation, and the speed of this machine."""

import platform
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, requires, version

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.options import complete_recipes, json_option
from raceway.console.progress import notice_compilation

EXTRAS = ("excel", "parquet", "zarr")
"""Optional requirements for users; the others are for developers."""


@click.command()
@click.option(
    "--speed",
    "recipe",
    metavar="RECIPE",
    shell_complete=complete_recipes,
    help="Measure the speed of this machine on a recipe.",
)
@click.option(
    "--records",
    type=click.IntRange(1, 16_384),
    metavar="N",
    help="Number of records to time with --speed; by default as many as take about ten seconds.",
)
@json_option
def doctor(recipe: str | None, records: int | None, as_json: bool) -> int:
    """Show installed versions, or the speed of this machine.

    Exits with 1 if a package that Raceway needs is missing or too old; a line that begins with "note" is of an optional one.

    With --speed one worker makes the first records of a corpus as generate makes them, stage by stage, and discards them; the CPU time is
    shown. Faults that are drawn again are included. Steps of the kernel are counted for records, settling time included. The
    last records of a corpus share batches that are not full: the more records, the higher the rate.

      raceway doctor
      raceway doctor --json
      raceway doctor --speed quickstart
    """
    if recipe is not None:
        _show_speed(recipe, records, as_json)
        return DONE
    if records is not None:
        raise click.UsageError("--records is for --speed; give both, or leave it out.")
    facts = list(_findings())
    problems = sum(one["state"] == "problem" for one in facts)
    if as_json:
        show.as_json({"problems": problems, "findings": facts})
    else:
        for one in facts:
            advice = f"; {one['advice']}" if one["advice"] else ""
            show.text(f"{one['state'].ljust(7)}  {one['subject']}: {one['value']}{advice}")
        wanting = f"{show.count_text(problems, 'problem')}."
        show.text("", wanting if problems else "Everything that Raceway needs is installed.")
    return FOUND_WANTING if problems else DONE


def _findings() -> Iterator[dict[str, str]]:
    """Versions of Python, Raceway and its requirements; the state of each, and advice where it is not ``fine``."""
    from packaging.requirements import Requirement

    yield _finding("Python", f"{platform.python_version()} ({sys.executable})")
    yield _finding("raceway", version("raceway"))
    for text in requires("raceway") or ():
        needed = Requirement(text)
        marker = needed.marker
        if marker is not None and not any(marker.evaluate({"extra": extra}) for extra in EXTRAS):
            continue
        try:
            present = version(needed.name)
            is_met = needed.specifier.contains(present, prereleases=True)
        except PackageNotFoundError:
            present, is_met = "missing", False
        advice = "" if is_met else f"pip install '{text.partition(';')[0].strip()}'."
        yield _finding(needed.name, present, "fine" if is_met else "note" if marker else "problem", advice)


def _finding(subject: str, value: str, state: str = "fine", advice: str = "") -> dict[str, str]:
    return {"subject": subject, "value": value, "state": state, "advice": advice}


def _show_speed(recipe: str, records: int | None, as_json: bool) -> None:
    from gen.recipe import find_recipe

    find_recipe(recipe)
    from raceway.timing import bench

    with notice_compilation():
        times = bench(recipe, records)
    if as_json:
        show.as_json(times)
        return
    show.text(f"{times.recipe}: {show.count_text(times.records, 'record')} on {times.machine['processor']}", "")
    show.table(
        ("stage", "ms per record"),
        ((name, f"{1e3 * s / times.records:.3g}") for name, s in times.stage_seconds.items()),
    )
    show.text("")
    show.facts(
        {
            "kernel": f"{times.kernel_record_steps_per_second / 1e6:,.3g} million record-steps/s",
            "corpus": f"{times.records_per_second:,.3g} records/s",
            "features": f"{times.features_records_per_second:,.3g} records/s",
        }
    )
