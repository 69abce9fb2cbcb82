"""Contents of a corpus, finished or not: the facts that ``raceway info`` shows.

They come from the manifest and from the per-record variables; no signal is read.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.corpus import (
    INDEX_NAME,
    LIFE,
    RECIPE_NAME,
    Manifest,
    by_class,
    class_counts,
    clipping_complaint,
    counts_in_words,
    extent,
    file_problems,
    open_records,
    read_manifest,
    specimen_numbers,
    unit_counts,
)
from gen.corpus.choice import channel_names, chosen_records, per_record
from gen.corpus.schema import operating_problems, stored_unit
from gen.support.errors import CorpusError, RecipeError
from gen.support.units import READABLE, range_text
from raceway.console import show
from raceway.console.corpus_counts import (
    OF_FAULTS,
    clipped_records,
    fault_counts,
    split_counts,
    step_complaint,
    text_counts,
)

Columns = Mapping[str, NDArray[Any]]

_SHOWN = [
    "sample_rate",
    "fault",
    "split",
    "rig",
    "specimen",
    "recording",
    "shaft_rate",
    "load",
    "bearing",
]
_IF_PRESENT = (*OF_FAULTS, "event", "clipped", "step_error", "oversampling")


def corpus_facts(directory: Path, where: str | None = None) -> dict[str, Any]:
    """Facts about a corpus: origin, state and contents, these of the records that meet a condition.

    Raises
    ------
    CorpusError
        If the folder holds no corpus, a part is missing or altered, or no record meets the condition.
    """
    manifest = read_manifest(directory)
    stored = manifest.model_dump(
        exclude={"parts", "complete", "records", "parts_sha256", "signals"}, exclude_unset=True
    )
    facts = {
        "corpus": directory,
        "complete": manifest.complete,
        "records": manifest.records,
        "parts": len(manifest.parts) or int(directory.is_file()),
        "parts_of_recipe": _parts_of_recipe(directory, manifest),
        "bytes": sum(path.stat().st_size for path in (directory, *directory.rglob("*")) if path.is_file()),
        "failures": [],
        "warnings": [],
        "skipped": [],
        "signals": manifest.signals,
        **stored,
    }
    return facts | _content(directory, manifest, where) if manifest.records else facts


def _parts_of_recipe(directory: Path, manifest: Manifest) -> int | None:
    """Number of parts that the recipe of a folder makes; None without a recipe of whole parts that can be read."""
    if manifest.recipe_sha256 is None or directory.is_file():
        return None
    from gen.recipe import read_recipe  # takes 0.2 s

    try:
        return read_recipe(directory / RECIPE_NAME, **manifest.overrides or {}).n_parts
    except RecipeError:
        return None


def _content(directory: Path, manifest: Manifest, where: str | None) -> dict[str, Any]:
    """Contents of a corpus; of an unfinished one those of its finished parts."""
    for problem in file_problems(directory, manifest, "size"):
        raise CorpusError(problem)
    rows = manifest.parts
    parts = [directory / "parts" / row.name for row in rows] or [directory]
    # the index has the labels of all parts; without it, each part has its own
    files = [directory / INDEX_NAME] if rows and manifest.complete else parts
    with open_records(files, parts, [row.records for row in rows] or None) as records:
        variables = per_record(records)
        measured = {
            name: stored_unit(records[name].attrs) for name in variables if records[name].attrs["role"] == "label"
        }
        sizes = {name: unit for name, unit in measured.items() if unit in READABLE}
        wanted = [*_SHOWN, *sizes, *(name for name in _IF_PRESENT if name in variables)]
        for name in wanted:
            if name not in records.variables:
                raise CorpusError(f"{files[0]}: has no variable {name}; make or copy the corpus again.")
        labels = {name: records[name].values for name in wanted}
        for problem in operating_problems(labels):
            raise CorpusError(f"{files[0]}: {problem}")
        if where is not None:
            (chosen,) = chosen_records([records], where)
            labels = {name: values[chosen] for name, values in labels.items()}
        channels, samples = channel_names(records), records.sizes["elapsed_time"]
    fs = float(labels["sample_rate"][0])
    units, clipped = unit_counts(labels), clipped_records(labels)
    clipping = clipping_complaint(sum((clipped or {}).values()), units.records)
    return {
        "chosen": units.records,
        "channels": channels,
        "sample_rate": fs,
        "duration": samples / fs,
        "samples": samples,
        "classes": class_counts(labels["fault"]),
        "splits": split_counts(labels["split"]),
        "bearings": text_counts(labels["bearing"].tolist()),
        "rigs": units.rigs,
        "specimens": units.specimens,
        "lives": _lives(labels),
        "recordings": units.recordings,
        "shaft_rate": _range(labels["shaft_rate"]),
        "load": _range(labels["load"]),
        "severities": _severities(labels, sizes),
        "units": sizes,
        "warnings": [*manifest.warnings, *filter(None, [clipping, step_complaint(labels)])],
        "clipped": clipped,
        "faults": None if (counts := fault_counts(labels)) is None else counts._asdict(),
    }


def _lives(labels: Columns) -> dict[str, int] | None:
    """Number of bearings by the end of their test; None unless the records are of lives."""
    if "event" not in labels:
        return None
    (names,) = (variable.flags for variable in LIFE if variable.name == "event")
    _, first = np.unique(specimen_numbers(labels), return_index=True)
    return text_counts(names[int(event)] for event in labels["event"][first])


def _severities(labels: Columns, names: Iterable[str]) -> dict[str, dict[str, list[float]]]:
    """Smallest and largest value of each label with a unit that is known and not 0, by class, in SI units."""
    ranges = {
        fault: {name: ends for name, values in columns.items() if (ends := _range(values[values != 0])) is not None}
        for fault, columns in by_class(labels, names).items()
    }
    return {fault: extents for fault, extents in ranges.items() if extents}


def _range(values: NDArray[Any]) -> list[float] | None:
    """Smallest and largest known value; None if no value is known."""
    ends = extent(values)
    return ends and [ends[0], ends[2]]


def show_facts(facts: dict[str, Any]) -> None:
    """Print the facts of `corpus_facts`; an unfinished corpus without a part has no contents yet."""
    overrides = [f"{key} {value}" for key, value in (facts.get("overrides") or {}).items() if value is not None]
    made_by = [", ".join([f"recipe {facts['recipe']}", *overrides])] if facts.get("recipe") else []
    made_by += [f"import {facts['importer']}"] if facts.get("importer") else []
    clipped, every = facts.get("clipped"), facts["parts_of_recipe"] or facts["parts"]
    state = "complete" if facts["complete"] else "unfinished; the command that began it completes it"
    unknown = facts.get("recipe_sha256") and facts["parts_of_recipe"] is None and facts["corpus"].is_dir()
    if facts["complete"] and unknown:
        state = f"complete, if its recipe has no more parts, which {RECIPE_NAME} does not tell"
    if facts["complete"] and facts["parts"] < every:
        state = f"{facts['parts']:,} of {show.count_text(every, 'part')} of its recipe; raceway copy joins them with the others"
    show.text(facts.get("title", str(facts["corpus"])), "")
    show.facts(
        {
            "corpus": facts["corpus"],
            "made by": ", ".join(made_by),
            "licence": facts.get("publication", {}).get("license", ""),
            "state": state,
            **(_shown_content(facts) if "classes" in facts else {}),
            "not usable": counts_in_words(facts["signals"]),
            "clipped": "" if clipped is None else f"at least once: {show.counts(clipped)}" if clipped else "none",
            "parts": f"{facts['parts']:,}",
            "size": show.size(facts["bytes"]),
            "versions": ", ".join(f"{name} {number}" for name, number in facts.get("versions", {}).items()),
        }
    )
    # what a user should know before using it
    for heading, key in (("Left out:", "failures"), ("Skipped:", "skipped"), ("Warnings:", "warnings")):
        if facts[key]:
            show.text("", heading, *(f"- {sentence}" for sentence in facts[key]))


def _shown_content(facts: dict[str, Any]) -> dict[str, str]:
    of_all = "" if facts["chosen"] == facts["records"] else f" of {facts['records']:,}, each"
    severities = {
        f"  {fault}": ", ".join(
            f"{name.replace('_', ' ')} {_shown_range(name, ends, facts['units'][name])}"
            for name, ends in ranges.items()
        )
        for fault, ranges in facts["severities"].items()
    }
    return {
        "records": f"{facts['chosen']:,}{of_all} of {facts['duration']:g} s at {facts['sample_rate']:g} Hz",
        "channels": ", ".join(facts["channels"]),
        "classes": show.counts(facts["classes"]),
        **severities,
        "faults": "" if facts["faults"] is None else _shown_faults(facts["faults"]),
        "splits": show.counts(facts["splits"]),
        "bearings": show.counts(facts["bearings"]),
        "rigs": f"{facts['rigs']:,}",
        "specimens": f"{facts['specimens']:,}",
        "lives": "" if facts["lives"] is None else show.counts(facts["lives"]),
        "recordings": f"{facts['recordings']:,}",
        "shaft rate": _shown_range("shaft_rate", facts["shaft_rate"], "Hz"),
        "load": _shown_range("load", facts["load"], "N"),
    }


def _shown_faults(counts: dict[str, int]) -> str:
    unseen = counts["records"] - counts["detectable"] - counts["unjudged"]
    judged = f"seen in {counts['detectable']:,} records, not seen in {unseen:,}, not judged in {counts['unjudged']:,}"
    return f"{judged}; {counts['redrawn_specimens']:,} specimens and {counts['redrawn_levels']:,} levels drawn again"


def _shown_range(name: str, ends: list[float] | None, stored: str) -> str:
    return "not known" if ends is None else range_text(name, ends[0], ends[1], stored)
