"""Commands that make corpora and look at them: recipes, plan, generate, validate, info, replay."""

import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show
from raceway.console.ending import DONE, FOUND_WANTING
from raceway.console.interruption import if_interrupted
from raceway.console.options import (
    Team,
    corpus_argument,
    file_option,
    json_option,
    recipe_argument,
    record_option,
    records_option,
    seed_option,
    target_option,
    where_option,
    worker_options,
)
from raceway.console.progress_bar import next_step, notice, notice_compilation, progress, warn

if TYPE_CHECKING:
    from collections.abc import Callable

    from gen.generation.corpus import Generated
    from gen.generation.plan import Plan
    from gen.recipe import Recipe

WORTH_WORKERS = 400  # records; up to these, starting a process takes about as long as it saves


@click.command()
@click.option(
    "--keys",
    "prefix",
    is_flag=False,
    flag_value="",
    metavar="[PREFIX]",
    help="List recipe keys that begin with PREFIX instead.",
)
@click.option(
    "--schema",
    is_flag=True,
    help="Print the JSON schema of recipes instead, for editors that complete and check keys; it checks no arguments of distributions "
    "and no keys against each other, as raceway plan does.",
)
@json_option
def recipes(prefix: str | None, schema: bool, as_json: bool) -> None:
    """List the shipped recipes, or the keys of recipes.

    Give any of the names where a command wants a RECIPE. To write your own, copy the nearest one and change it. For each key, --keys
    prints its unit, allowed values, default and meaning; `distribution` has the keys of distributions.

      raceway recipes
      raceway recipes --keys
      raceway recipes --keys machine
      raceway recipes --keys faults.width_mm --json
      raceway recipes --schema > recipe.schema.json
    """
    if schema:
        from gen.recipe import recipe_schema

        show.text(recipe_schema().rstrip())
        return
    if prefix is not None:
        _show_keys(prefix, as_json)
        return
    from gen.recipe import recipe_purpose, shipped_recipes

    paths = shipped_recipes()
    purposes = {name: recipe_purpose(path) for name, path in paths.items()}
    if as_json:
        listed = [{"name": name, "purpose": purposes[name], "path": path} for name, path in paths.items()]
        show.as_json({"recipes": listed})
        return
    show.definitions(purposes)
    show.text("", f"Their files are in {next(iter(paths.values())).parent}.")


def _show_keys(prefix: str, as_json: bool) -> None:
    from gen.recipe.keys import Key, recipe_keys

    keys = recipe_keys(prefix)
    if as_json:
        show.as_json({"keys": [key._asdict() for key in keys]})
        return
    show.columns([Key._fields, *(key._replace(kinds="/".join(key.kinds)) for key in keys)])


@click.command()
@recipe_argument
@seed_option
@records_option
@json_option
def plan(recipe: str, seed: int | None, records: int | None, as_json: bool) -> None:
    """Show counts, size and time of a corpus; write nothing.

    Records are drawn and checked in the same way as by generate, so that both refuse the same recipes. Time, size and visible faults are
    those of some records that are made, of 2 s at most, once this machine has the kernel; half of the time and twice as much are common.

      raceway plan quickstart
      raceway plan my_recipe.yaml --records 100 --json

    Next: raceway generate RECIPE -o DIR
    """
    from gen.recipe import find_recipe

    find_recipe(recipe)
    from gen.generation.plan import plan as plan_recipe

    planned = plan_recipe(recipe, seed=seed, records=records)
    if as_json:
        show.as_json(planned)
    else:
        _show_plan(planned)


def _show_plan(planned: "Plan") -> None:
    steps = list(planned.steps_per_sample)
    # of a large corpus a part is drawn, and a part of this is checked
    about, about_checked = (
        "" if count == planned.records else f" (scaled up from {count:,} {done} records)"
        for count, done in ((planned.drawn, "drawn"), (planned.checked, "checked"))
    )
    seconds = planned.seconds
    visible = ", ".join(f"{fault} {seen} of {judged}" for fault, (seen, judged) in planned.seen.items())
    without = f", without {planned.left_out:,} that cannot be simulated{about_checked}" if planned.left_out else ""
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
            "visible": visible and f"{visible} faults in the records that were made",
            "size": f"{'about' if seconds else 'up to'} {show.size(planned.bytes)}",
            "steps": f"{steps[0]} to {steps[-1]} per sample" if len(steps) > 1 else f"{steps[0]} per sample",
            "time": f"roughly {show.duration(seconds)} on one core, by some of its records" if seconds else "",
            "kernel": "compiled" if planned.compiled else "will be compiled for this machine, in half a minute or so",
        }
    )
    if planned.left_out_example is not None:
        show.text("", f"One record that is left out: {planned.left_out_example}")
    if planned.clipping is not None:
        show.text("", f"Of those that were made, {planned.clipping}")
    if planned.first_wide_spall is not None:
        show.text(
            "",
            f"Spalls under two balls at once: {planned.wide_spalls:,} records{about}. The first is {planned.first_wide_spall}",
        )


def _range_of(_context: click.Context, _option: click.Parameter, text: str | None) -> range | None:
    """Parts from their first and last number, ``A-B``, or from one number."""
    if text is None:
        return None
    first, dash, last = text.partition("-")
    last = last if dash else first
    if not (text.isascii() and first.isdecimal() and last.isdecimal()):  # Arabic digits are decimal too
        raise click.BadParameter(f"{text!r} is no range; give the first and the last part, such as 0-4.")
    return range(int(first), int(last) + 1)


@click.command()
@recipe_argument
@target_option("The corpus: a file if the name ends in .nc, else a folder; new, or begun by this command.")
@worker_options
@seed_option
@records_option
@click.option(
    "--parts",
    metavar="A-B",
    callback=_range_of,
    help="Make the parts A to B alone; copy joins them with those of other machines.",
)
@json_option
def generate(recipe: str, output: Path, team: Team, as_json: bool, **options: Any) -> int:
    """Generate the corpus of RECIPE as TARGET, or complete one.

    The corpus is a folder, or one netCDF file if TARGET ends in .nc. It is generated in parts; those of a file NAME.nc lie in the folder
    NAME.nc.parts until it is whole. If the command is interrupted, finished parts are kept, and the same command completes the corpus.
    With a larger --records it grows: a finished corpus in a folder gets the records that it lacks, and is then the one made at once; a part
    that was not full is made again, and so may be one whose steps are checked.
    The bytes of the parts do not depend on the number of workers, which are processes: one up to 400 records, by default one per core
    beyond.

    Exits with 1 if more than 1 % of the records cannot be used, because more than 5 % of the samples of a channel are clipped, or all
    are zeros, constant or not numbers; the corpus is kept. Records with fewer clipped samples are counted and can be used.

      raceway generate quickstart -o corpus
      raceway generate quickstart -o corpus.nc
      raceway generate domain_randomised -o large --workers 8
      raceway generate my_recipe.yaml -o try --records 20 --seed 7
      raceway generate my_recipe.yaml -o try --records 60 --seed 7
      raceway generate domain_randomised -o second_half --parts 5-9

    Next: raceway info DIR, raceway benchmark DIR -o REPORT
    """
    from gen.recipe import read_recipe

    # a misspelt name is reported before the simulator is imported
    wanted = read_recipe(recipe, seed=options["seed"], records=options["records"])
    from gen import generate as generate_corpus
    from gen.corpus import clipping_complaint, complaint
    from gen.support.executor import cores
    from raceway.sharing import describe

    start = time.monotonic()
    usual = min(cores(), wanted.n_parts) if wanted.n_records > WORTH_WORKERS else 1
    options |= {"workers": team.workers or usual, "scheduler": team.scheduler}
    # after Ctrl-C: how many records are kept, and how to go on
    with if_interrupted(_kept(output, wanted)), progress("generating", "records") as report:
        generated = generate_corpus(recipe, output, **options, progress=report, notice=notice)
        if generated.path.is_dir():
            describe(generated.path)
    for failure in generated.failures:
        notice(f"left out: {failure}")
    useless = complaint(generated.signals, generated.records)
    clipping = clipping_complaint(generated.clipped, generated.records)
    for sentence in filter(None, (useless, clipping, _coarse_steps(generated.path))):
        warn(sentence)
    if as_json:
        facts = {name: getattr(generated, name) for name in ("records", "parts", "kept", "failures", "clipped")}
        seconds = round(time.monotonic() - start, 3)
        show.as_json({"corpus": generated.path, **facts, "signals": generated.signals, "seconds": seconds})
    else:
        _show_generated(generated, wanted)
    # a corpus that no analysis can use is a failure for scripts
    return DONE if useless is None else FOUND_WANTING


def _show_generated(generated: "Generated", wanted: "Recipe") -> None:
    from gen.corpus import counts_in_words

    kept = f", {generated.kept} of them kept from before" if generated.kept else ""
    unusable = f"; {counts_in_words(generated.signals)} cannot be used" if generated.signals else ""
    failed = f"; {show.count_text(len(generated.failures), 'record')} left out" if generated.failures else ""
    size = f"{show.count_text(generated.records, 'record')} in {show.count_text(generated.parts, 'part')}"
    show.text(f"{generated.path}: {size}{kept}{failed}{unusable}.")
    # lives that ended before their last snapshot
    missing = wanted.n_records - generated.records - len(generated.failures)
    if wanted.life is not None and missing and generated.parts == wanted.n_parts:
        show.text(f"The other {missing:,} of {wanted.n_records:,} snapshots would come after the end of a life.")
    if generated.parts < wanted.n_parts:
        show.text(f"The recipe has {wanted.n_parts:,} parts; raceway copy joins these with the others.")
    next_step(f"raceway info {shlex.quote(str(generated.path))}")


def _coarse_steps(corpus: Path) -> str | None:
    """Sentence about the records whose step is too coarse."""
    from gen.corpus import open_corpus
    from raceway.console.corpus_counts import step_complaint

    with open_corpus(corpus, check="size") as opened:
        return step_complaint(opened)


def _kept(corpus: Path, recipe: "Recipe") -> "Callable[[], str]":
    """Function that removes the unfinished files of the workers and returns a sentence about the parts that are kept.

    It imports nothing: the main thread may hold the lock of an import when it is called.
    """
    from gen.corpus import is_single_file, part_number, remove_temporary_files

    folder = corpus.with_name(f"{corpus.name}.parts") if is_single_file(corpus) else corpus

    def told() -> str:
        remove_temporary_files(folder)
        parts = {part_number(path.name) for path in (folder / "parts").glob("part-*.nc")} - {None}
        of_all = f"{len(parts)} of {show.count_text(recipe.n_parts, 'part')}"
        return f"interrupted; {of_all} kept in {folder}; the same command completes the corpus."

    return told


@click.command()
@corpus_argument
@json_option
def validate(corpus: Path, as_json: bool) -> int:
    """Check the records of the corpus in DIR.

    Exits with 1 if anything is wrong. The checks cover the hash of each part and of index.nc, the format, all samples, whether
    index.nc agrees with manifest, recipe and parts, and croissant.json, if there, with the corpus. They leave out README.md, card.json,
    pictures and files that are no part of a corpus. It warns of records whose step was too coarse, and of
    splits of an imported corpus that can leak: one recording under two specimens, each file a specimen of its own, a class of one
    specimen.

      raceway validate corpus && echo sound
    """
    from gen.corpus import is_single_file, read_manifest, validate_corpus
    from raceway.sharing import croissant_problems

    if not (corpus.is_file() and is_single_file(corpus)) and not (corpus / "manifest.json").exists():
        # raises: a folder without a manifest, or another file, is bad input, not a damaged corpus
        read_manifest(corpus)
    problems = validate_corpus(corpus) or croissant_problems(corpus)
    warnings: list[str] = []
    if not problems:
        warnings += filter(None, [_coarse_steps(corpus)])
    if not problems and read_manifest(corpus).importer is not None:
        from features.auditing import audit_splits

        warnings += audit_splits(corpus)
    for sentence in warnings:
        warn(sentence)
    if as_json:
        show.as_json({"corpus": corpus, "valid": not problems, "problems": problems, "warnings": warnings})
    elif problems:
        show.text(*problems)
    else:
        show.text(f"{corpus}: sound.")
    return FOUND_WANTING if problems else DONE


@click.command()
@corpus_argument
@where_option
@json_option
def info(corpus: Path, where: str | None, as_json: bool) -> None:
    """Show the contents of the corpus in DIR.

    Origin, state, classes with the range of their severities, operating conditions, size and versions. DIR may be generated or
    imported, and a folder unfinished; its index.nc stands for the folder.

      raceway info corpus
      raceway info corpus --where "fault == 'inner' and width_mm > 0.5"
      raceway info corpus --json
    """
    from raceway.console.summary import corpus_facts, show_facts

    facts = corpus_facts(corpus, where)
    if as_json:
        show.as_json(facts)
    else:
        show_facts(facts)


@click.command()
@corpus_argument
@record_option
@file_option("FILE.nc", "Write the new record here.", (".nc",), required=False)
@file_option(
    "FILE.yaml",
    "Write the scenario of the record here, as a recipe.",
    (".yaml", ".yml"),
    required=False,
    flags=("--recipe",),
)
@json_option
def replay(corpus: Path, record: int, output: Path | None, recipe: Path | None, as_json: bool) -> int:
    """Simulate one record of DIR again and compare it.

    The record is simulated from the scenario that DIR stores with it. Exits with 1 if its bits differ from those of the stored record, as
    they can on a processor without fused multiply-add or with other versions of the libraries. With --recipe, the scenario becomes a recipe
    of this record alone, with each drawn number in place of its distribution: generate makes the record again from it, or another one
    after a change such as that of a width or of the speed.

      raceway replay corpus --record 17
      raceway replay corpus --record 17 -o record.nc
      raceway replay corpus --record 17 --recipe record.yaml
    """
    from gen import read_scenarios, write_recipe
    from gen import replay as replay_record
    from gen.corpus import write_part

    with notice_compilation():
        again = replay_record(corpus, record)
    if output is not None:
        write_part(again.dataset, output)
    if recipe is not None:
        (scenario,) = read_scenarios(again.dataset)
        write_recipe(scenario.recipe, recipe)
    if as_json:
        facts = {"corpus": corpus, "record": record, "identical": again.identical, "output": output, "recipe": recipe}
        show.as_json(facts)
    else:
        verdict = "identical" if again.identical else "differs; raceway info shows the versions that made the corpus"
        written = [f"written to {path}." for path in (output, recipe) if path is not None]
        show.text(f"{corpus}: record {record}: {verdict}.", *written)
    # a record that differs is a failure for scripts
    return DONE if again.identical else FOUND_WANTING
