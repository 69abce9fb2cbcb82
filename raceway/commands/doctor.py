"""A command about this machine and installation."""

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.options import complete_recipes, json_option
from raceway.console.progress import notice_compilation


@click.command()
@click.option(
    "--speed",
    "recipe",
    metavar="RECIPE",
    shell_complete=complete_recipes,
    help="Measure the speed of this machine on a recipe instead.",
)
@click.option(
    "--records",
    type=click.IntRange(1, 16_384),
    metavar="N",
    help="Number of records to time with --speed; by default those of one part.",
)
@json_option
def doctor(recipe: str | None, records: int | None, as_json: bool) -> int:
    """Show what this machine and installation can do.

    Versions, cores, memory and disk, compiled kernels, codecs, optional packages, readers of other projects, and the speed of the kernel
    against the published figure; with advice where something is missing or amiss. Takes some seconds.

    Exits with 1 if something that Raceway needs is missing; a line that begins with "note" is no fault.

    With --speed one worker makes the first part of a corpus several times, stage by stage, and discards it; the medians of the CPU time
    are shown. Integration steps are counted for records, settling time included, and not for empty lanes.

      raceway doctor
      raceway doctor --json
      raceway doctor --speed quickstart
    """
    if recipe is not None:
        _show_speed(recipe, records, as_json)
        return DONE
    if records is not None:
        raise click.UsageError("--records is for --speed; give both, or leave it out.")
    from raceway.studies.doctor import findings

    facts = []
    for one in findings():
        facts.append(one)
        if not as_json:
            show.text(f"{one.state.ljust(7)}  {one.subject}: {one.value}{f'; {one.advice}' if one.advice else ''}")
    problems = sum(one.state == "problem" for one in facts)
    if as_json:
        show.as_json({"problems": problems, "findings": [one._asdict() for one in facts]})
    else:
        show.text(
            "", "Everything that Raceway needs is here." if not problems else f"{show.count_text(problems, 'problem')}."
        )
    return FOUND_WANTING if problems else DONE


def _show_speed(recipe: str, records: int | None, as_json: bool) -> None:
    from gen.recipe import find_recipe

    find_recipe(recipe)
    from raceway.studies.timing import bench

    with notice_compilation():
        times = bench(recipe, records)
    if as_json:
        show.as_json(times)
        return
    show.text(
        f"{times.recipe}: {show.count_text(times.records, 'record')}, median of {show.count_text(times.repeats, 'run')} on "
        f"{times.machine['processor']}",
        "",
    )
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
