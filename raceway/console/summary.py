"""Contents of a corpus, finished or not: the facts that ``raceway info`` shows.

They come from the manifest and from the per-record variables; no signal is read.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gen.corpus import (
    DRAWS,
    FAULT_NAMES,
    SPLITS,
    Manifest,
    SignalCounts,
    counts_in_words,
    fault_counts,
    open_corpus,
    open_part,
    plain_file,
    read_manifest,
    step_complaint,
)
from gen.corpus.visible import VARIABLES
from raceway.console import show

_SHOWN = [
    "sample_rate",
    "fault",
    "split",
    "bearing",
    "rig",
    "specimen",
    "recording",
    "shaft_rate",
    "load",
    "channel",
    "elapsed_time",
    "width",
    "depth",
]
# severity of a fault, with the unit in which it is shown and its size in SI units; the last three are variables of simulated corpora
_SEVERITIES = {
    "width": ("mm", 1e-3),
    "depth": ("um", 1e-6),
    "wear": ("um", 1e-6),
    "pitch_error": ("deg", math.pi / 180),
    "knock": ("N", 1.0),
}


def describe(directory: Path) -> dict[str, Any]:
    """Facts about a corpus: origin, state and contents.

    Raises
    ------
    CorpusError
        If the folder holds no corpus, or a part is missing or altered.
    """
    manifest = read_manifest(directory)
    known = manifest.model_dump(exclude={"parts", "complete", "records", "parts_sha256", "signals"}, exclude_unset=True)
    about = {
        "corpus": directory,
        "complete": manifest.complete,
        "records": manifest.records,
        "parts": len(manifest.parts) or int(directory.is_file()),
        "bytes": sum(path.stat().st_size for path in (directory, *directory.rglob("*")) if path.is_file()),
        "failures": [],
        "warnings": [],
        "skipped": [],
        "signals": manifest.signals._asdict(),
    }
    facts = about | known
    if manifest.records:
        labels = _labels(directory, manifest)
        facts |= _content(labels)
        facts["warnings"] = [*facts["warnings"], *filter(None, [step_complaint(labels)])]
    return facts


def _labels(directory: Path, manifest: Manifest) -> xr.Dataset:
    """Variables that ``info`` shows; of an unfinished corpus those of its finished parts."""
    if manifest.complete:
        with open_corpus(directory, check="size") as corpus:
            return _shown(corpus)
    parts = []
    for row in manifest.parts:
        with open_part(plain_file(directory, f"parts/{row.name}")) as part:
            parts.append(_shown(part))
    whole: Any = xr.concat(parts, "record", data_vars="minimal", coords="minimal", compat="override", join="override")
    return whole


def _shown(records: xr.Dataset) -> xr.Dataset:
    known = [name for name in (*_SEVERITIES, *VARIABLES, "step_error", "oversampling") if name in records.variables]
    return records.drop_vars(DRAWS, errors="ignore")[[*_SHOWN, *known]].load()


def _content(labels: xr.Dataset) -> dict[str, Any]:
    fs = float(labels["sample_rate"][0])
    return {
        "title": str(labels.attrs.get("title", "")),
        "channels": [str(name) for name in labels["channel"].values],
        "sample_rate": fs,
        "duration": labels.sizes["elapsed_time"] / fs,
        "samples": labels.sizes["elapsed_time"],
        "classes": _named_counts(labels["fault"].values, FAULT_NAMES),
        "splits": _named_counts(labels["split"].values, dict(enumerate(SPLITS))),
        "bearings": _counts(labels["bearing"].values),
        "rigs": _distinct(labels["rig"].values),
        "specimens": _distinct(labels["rig"].values, labels["specimen"].values),
        "recordings": _distinct(labels["rig"].values, labels["specimen"].values, labels["recording"].values),
        "shaft_rate": _range(labels["shaft_rate"].values),
        "load": _range(labels["load"].values),
        "severities": _severities(labels),
        "faults": None if (counts := fault_counts(labels)) is None else counts._asdict(),
    }


def _severities(labels: xr.Dataset) -> dict[str, dict[str, list[float]]]:
    """Smallest and largest value of each severity that is known and not 0, by class, in SI units."""
    by_class: dict[str, dict[str, list[float]]] = {}
    for code, fault in FAULT_NAMES.items():
        rows = labels["fault"].values == code
        values = {name: labels[name].values[rows] for name in _SEVERITIES if name in labels.variables}
        ranges = {name: _range(some[some != 0]) for name, some in values.items()}
        known = {name: ends for name, ends in ranges.items() if ends is not None}
        if known:
            by_class[fault] = known
    return by_class


def _named_counts(codes: np.ndarray, names: Mapping[int, str]) -> dict[str, int]:
    return {name: int((codes == code).sum()) for code, name in names.items() if (codes == code).any()}


def _counts(values: np.ndarray) -> dict[str, int]:
    names, numbers = np.unique(values.astype(str), return_counts=True)
    return dict(zip(names.tolist(), numbers.tolist(), strict=True))


def _distinct(*keys: np.ndarray) -> int:
    return np.unique(np.stack(keys), axis=1).shape[1]


def _range(values: np.ndarray) -> list[float] | None:
    """Smallest and largest known value; None if no value is known."""
    known = values[np.isfinite(values)]
    return [float(known.min()), float(known.max())] if known.size else None


def show_facts(facts: dict[str, Any]) -> None:
    """Print the facts of ``describe``; an unfinished corpus without a part has no contents yet."""
    overrides = {key: value for key, value in (facts.get("overrides") or {}).items() if value is not None}
    with_overrides = "".join(f", {key} {value}" for key, value in overrides.items())
    made_by = [f"recipe {facts['recipe']}{with_overrides}"] if "recipe" in facts else []
    made_by += [f"import {facts['importer']}"] if "importer" in facts else []
    show.text(facts.get("title", str(facts["corpus"])), "")
    known = {"corpus": facts["corpus"], "made by": ", ".join(made_by)}
    if license_name := facts.get("publication", {}).get("license"):
        known["licence"] = license_name
    known["state"] = "complete" if facts["complete"] else "unfinished; the command that began it completes it"
    if "classes" in facts:
        known |= _shown_content(facts)
    known["not usable"] = counts_in_words(SignalCounts(**facts["signals"]))
    known |= {"parts": f"{facts['parts']:,}", "size": show.size(facts["bytes"])}
    known["versions"] = ", ".join(f"{name} {number}" for name, number in facts.get("versions", {}).items())
    show.facts(known)
    for heading, key in (("Left out:", "failures"), ("Skipped:", "skipped"), ("Warnings:", "warnings")):
        if facts[key]:
            show.text("", heading, *(f"- {sentence}" for sentence in facts[key]))


def _shown_content(facts: dict[str, Any]) -> dict[str, str]:
    return {
        "records": f"{facts['records']:,} of {facts['duration']:g} s at {facts['sample_rate']:g} Hz",
        "channels": ", ".join(facts["channels"]),
        "classes": show.counts(facts["classes"]),
        **{f"  {fault}": _shown_severities(ranges) for fault, ranges in facts["severities"].items()},
        **({} if facts["faults"] is None else {"faults": _shown_faults(facts["faults"])}),
        "splits": show.counts(facts["splits"]),
        "bearings": show.counts(facts["bearings"]),
        "rigs": f"{facts['rigs']:,}",
        "specimens": f"{facts['specimens']:,}",
        "recordings": f"{facts['recordings']:,}",
        "shaft rate": _shown_range(facts["shaft_rate"], "Hz"),
        "load": _shown_range(facts["load"], "N"),
    }


def _shown_faults(counts: dict[str, int]) -> str:
    if counts["unjudged"] == counts["records"]:
        return "not judged"
    again = f"{counts['redrawn_specimens']:,} specimens and {counts['redrawn_levels']:,} levels drawn again"
    return f"seen in {counts['detectable']:,} of {counts['records']:,} records, {again}"


def _shown_severities(ranges: dict[str, list[float]]) -> str:
    parts = []
    for name, ends in ranges.items():
        unit, scale = _SEVERITIES[name]
        parts.append(f"{name.replace('_', ' ')} {_shown_range([end / scale for end in ends], unit)}")
    return ", ".join(parts)


def _shown_range(ends: list[float] | None, unit: str) -> str:
    """Range in words.

    >>> _shown_range([2.0, 2.0], "N"), _shown_range([0.5, 1.25], "mm"), _shown_range(None, "N")
    ('2 N', '0.5 to 1.25 mm', 'not known')
    """
    if ends is None:
        return "not known"
    low, high = (f"{end:.3g}" for end in ends)
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"
