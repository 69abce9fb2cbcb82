"""Commands that make corpora and look at them: recipes, plan, generate, validate, info, replay."""

import os
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.options import (
    corpus_argument,
    file_option,
    folder_option,
    json_option,
    recipe_argument,
    record_option,
    records_option,
    seed_option,
)
from raceway.console.progress import compilation_noticed, notice, progress
from raceway.console.signals import if_interrupted

if TYPE_CHECKING:
    from gen.plan import Plan
    from gen.recipe import Recipe

WORTH_WORKERS = 1000  # records; a cluster takes about as long to start as these take to make


@click.command()
@click.option(
    "--keys",
    "prefix",
    is_flag=False,
    flag_value="",
    metavar="[PREFIX]",
    help="List recipe keys that begin with PREFIX instead.",
)
@json_option
def recipes(prefix: str | None, as_json: bool) -> None:
    """List the shipped recipes, or the keys of recipes.

    Give any of the names where a command wants a RECIPE. To write your own, copy the nearest one and change it. For each key, --keys
    prints its unit, allowed values, default and meaning; `distribution` has the keys of distributions.

      raceway recipes
      raceway recipes --keys
      raceway recipes --keys machine
      raceway recipes --keys faults.width_mm --json
    """
    if prefix is not None:
        _show_keys(prefix, as_json)
        return
    from gen.recipe import recipe_purpose, shipped_recipes

    found = shipped_recipes()
    purposes = {name: recipe_purpose(path) for name, path in found.items()}
    if as_json:
        listed = [{"name": name, "purpose": purposes[name], "path": path} for name, path in found.items()]
        show.as_json({"recipes": listed})
        return
    show.definitions(purposes)
    show.text("", f"Their files are in {next(iter(found.values())).parent}.")


def _show_keys(prefix: str, as_json: bool) -> None:
    from gen.recipe.keys import Key, recipe_keys

    keys = recipe_keys(prefix)
    if as_json:
        show.as_json({"keys": [key._asdict() for key in keys]})
        return
    rows = [Key._fields, *(key._replace(kinds="/".join(key.kinds)) for key in keys)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        show.text("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())


@click.command()
@recipe_argument
@seed_option
@records_option
@json_option
def plan(recipe: str, seed: int | None, records: int | None, as_json: bool) -> None:
    """Say what RECIPE would make: counts, size, time. Nothing is written.

    Records are drawn and checked as generate does, so that what it would refuse is refused here. The time is a rough one.

      raceway plan quickstart
      raceway plan my_recipe.yaml --records 100 --json

    Next: raceway generate RECIPE -o DIR
    """
    from gen.plan import plan as plan_recipe

    planned = plan_recipe(recipe, seed=seed, records=records)
    if as_json:
        show.as_json(planned)
    else:
        _show_plan(planned)


def _show_plan(planned: "Plan") -> None:
    steps = list(planned.steps_per_sample)
    about = "" if planned.drawn == planned.records else f" (scaled up from {planned.drawn:,} that were drawn)"
    without = f", without {planned.left_out:,} that cannot be simulated{about}" if planned.left_out else ""
    show.text(planned.title, "")
    show.facts(
        {
            "recipe": f"{planned.recipe}, seed {planned.seed}",
            "records": f"{planned.records:,} of {planned.duration:g} s at {planned.sample_rate:g} Hz{without}",
            "channels": ", ".join(planned.channels),
            "rigs": f"{planned.rigs:,}",
            "specimens": f"{planned.specimens:,}",
            "classes": show.counts(planned.classes) + about,
            "splits": show.counts(planned.splits) + about,
            "parts": f"{planned.parts:,}",
            "size": f"about {show.size(planned.bytes)}",
            "steps": f"{steps[0]} to {steps[-1]} per sample" if len(steps) > 1 else f"{steps[0]} per sample",
            "time": f"about {show.duration(planned.estimated_seconds)} with one worker",
            "kernels": f"{planned.kernels}, to be compiled once per machine in about {show.duration(planned.compile_seconds)}",
        }
    )
    if planned.first_left_out is not None:
        show.text("", f"The first that is left out: {planned.first_left_out}")


@click.command()
@recipe_argument
@folder_option("DIR", "Folder of the corpus; new, empty, or one that this command began.")
@click.option("--workers", type=click.IntRange(min=1), metavar="N", help="Processes on this machine.")
@click.option("--scheduler", metavar="ADDR", help="Address of a dask scheduler to use instead.")
@seed_option
@records_option
@json_option
def generate(
    recipe: str,
    output: Path,
    workers: int | None,
    scheduler: str | None,
    seed: int | None,
    records: int | None,
    as_json: bool,
) -> int:
    """Make the corpus of RECIPE in DIR, or complete one.

    The corpus is made in parts. When the command is interrupted, finished parts are kept and the same command goes on from there; the
    result is the same to the bit, whatever the number of workers. By default there is a worker per core for more than 1000 records in
    two parts or more, else one.

    Exits with 1 if more than 1 % of the records cannot be used, because they are clipped, all zeros or not numbers; the corpus is kept.

      raceway generate quickstart -o corpus
      raceway generate domain_randomised -o large --workers 8
      raceway generate my_recipe.yaml -o try --records 20 --seed 7

    Next: raceway info DIR, raceway benchmark DIR -o REPORT
    """
    from gen import generate as generate_corpus
    from gen import read_recipe
    from gen.corpus import complaint, described

    wanted = read_recipe(recipe, seed=seed, records=records)
    start = time.monotonic()
    with (
        if_interrupted(partial(_kept, output, wanted)),
        compilation_noticed(),
        progress("generating", "records") as report,
    ):
        made = generate_corpus(
            recipe,
            output,
            workers=workers or _default_workers(wanted),
            scheduler=scheduler,
            seed=seed,
            records=records,
            progress=report,
        )
    for failure in made.failures:
        notice(f"left out: {failure}")
    useless = complaint(made.signals, made.records)
    if useless is not None:
        notice(useless)
    ending = DONE if useless is None else FOUND_WANTING
    seconds = time.monotonic() - start
    if as_json:
        names = ("records", "parts", "kept", "failures")
        facts = {name: getattr(made, name) for name in names}
        show.as_json(
            {"corpus": made.directory, **facts, "signals": made.signals._asdict(), "seconds": round(seconds, 3)}
        )
        return ending
    kept = f", {made.kept} of them kept from before" if made.kept else ""
    unusable = f"; {described(made.signals)} cannot be used" if any(made.signals) else ""
    failed = f"; {len(made.failures)} could not be simulated and are left out" if made.failures else ""
    show.text(f"{made.directory}: {made.records:,} records in {made.parts:,} parts{kept}{failed}{unusable}.")
    return ending


def _kept(corpus: Path, recipe: "Recipe") -> str:
    """Remove what the workers were writing, and say what is kept."""
    from gen.corpus import read_manifest, remove_left_behind
    from gen.errors import RacewayError

    remove_left_behind(corpus / "parts", "part-*.nc")
    try:
        parts = len(read_manifest(corpus).parts)
    except RacewayError:  # before the first part
        parts = 0
    return (
        f"interrupted; {parts} of {recipe.n_parts} parts are kept in {corpus}, and the same command goes on from there."
    )


def _default_workers(recipe: "Recipe") -> int:
    if recipe.n_parts < 2 or recipe.n_records <= WORTH_WORKERS:
        return 1
    return min(len(os.sched_getaffinity(0)), recipe.n_parts)


@click.command()
@corpus_argument
@json_option
def validate(corpus: Path, as_json: bool) -> int:
    """Check every byte of the corpus in DIR.

    Exits with 1 if anything is wrong. Looked at are the manifest, the hash and format of each part, the samples, and whether
    corpus.nc says the same as the parts.

      raceway validate corpus && echo sound
    """
    from gen.corpus import read_manifest, validate_corpus

    if not (corpus / "manifest.json").exists():
        read_manifest(corpus)  # raises: this is no corpus, not a corpus with a fault
    problems = validate_corpus(corpus)
    if as_json:
        show.as_json({"corpus": corpus, "valid": not problems, "problems": problems})
    elif problems:
        show.text(*problems)
    else:
        show.text(f"{corpus}: sound.")
    return FOUND_WANTING if problems else DONE


@click.command()
@corpus_argument
@json_option
def info(corpus: Path, as_json: bool) -> None:
    """Say what is in the corpus in DIR.

    It may be generated or imported, finished or not.

      raceway info corpus
      raceway info corpus --json
    """
    from raceway.console.summary import describe

    facts = describe(corpus)
    if as_json:
        show.as_json(facts)
    else:
        _show_info(facts)


def _show_info(facts: dict) -> None:
    """Show what ``describe`` found; an unfinished corpus without a part has no content yet."""
    from gen.corpus import SignalCounts, described

    overrides = {key: value for key, value in facts.get("overrides", {}).items() if value is not None}
    with_overrides = "".join(f", {key} {value}" for key, value in overrides.items())
    origin = f"recipe {facts['recipe']}{with_overrides}" if "recipe" in facts else f"import {facts.get('importer')}"
    show.text(facts.get("title", str(facts["corpus"])), "")
    known = {"corpus": facts["corpus"], "made by": origin}
    known["state"] = "complete" if facts["complete"] else "unfinished; the command that began it completes it"
    if "classes" in facts:
        known |= {
            "records": f"{facts['records']:,} of {facts['duration']:g} s at {facts['sample_rate']:g} Hz",
            "channels": ", ".join(facts["channels"]),
            "classes": show.counts(facts["classes"]),
            "splits": show.counts(facts["splits"]),
            "bearings": show.counts(facts["bearings"]),
            "rigs": f"{facts['rigs']:,}",
            "specimens": f"{facts['specimens']:,}",
            "recordings": f"{facts['recordings']:,}",
            "shaft rate": _range(facts["shaft_rate"], "Hz"),
            "load": _range(facts["load"], "N"),
        }
    if "signals" in facts:
        known["not usable"] = described(SignalCounts(**facts["signals"]))
    known |= {"parts": f"{facts['parts']:,}", "size": show.size(facts["bytes"])}
    known["versions"] = ", ".join(f"{name} {number}" for name, number in facts.get("versions", {}).items())
    show.facts(known)
    for heading, key in (("Left out:", "failures"), ("Skipped:", "skipped"), ("Warnings:", "warnings")):
        if facts[key]:
            show.text("", heading, *(f"- {sentence}" for sentence in facts[key]))


def _range(ends: list[float] | None, unit: str) -> str:
    return "not known" if ends is None else f"{ends[0]:.3g} to {ends[1]:.3g} {unit}"


@click.command()
@corpus_argument
@record_option
@file_option("FILE.nc", "Write the new record here.", (".nc",), required=False)
@json_option
def replay(corpus: Path, record: int, output: Path | None, as_json: bool) -> int:
    """Make one record of DIR again and compare.

    The record is drawn and simulated from the recipe in DIR. Exits with 1 if it and the stored one are not the same to the bit, as can
    be on a processor without fused multiply-add or with other versions of the libraries.

      raceway replay corpus --record 17
      raceway replay corpus --record 17 -o record.nc
    """
    from gen import replay as replay_record
    from gen.corpus import write_part

    with compilation_noticed():
        again = replay_record(corpus, record)
    if output is not None:
        write_part(again.dataset, output)
    if as_json:
        show.as_json({"corpus": corpus, "record": record, "identical": again.identical, "output": output})
    else:
        verdict = "identical" if again.identical else "differs; raceway info names the versions it was made with"
        show.text(f"{corpus}: record {record}: {verdict}.", *([f"written to {output}."] if output else []))
    return DONE if again.identical else FOUND_WANTING
