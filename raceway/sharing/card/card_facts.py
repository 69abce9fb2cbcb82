"""Facts of a corpus for its data card: counts by class and split, ranges, meanings, the command that makes it again."""

from typing import Any

import numpy as np
import xarray as xr

from gen.corpus.choice import per_record
from gen.corpus.contents import (
    UNITS,
    by_class,
    extent,
    unit_counts,
)
from gen.corpus.manifest import RECIPE_NAME, Manifest
from gen.corpus.schema import ROLES, SPLITS, stored_unit
from gen.corpus.unusable import counts_in_words
from raceway.console.corpus_counts import (
    clipped_records,
    fault_counts,
    split_counts,
    text_counts,
    units_in_several_splits,
)

_NEW = "../again"


def card_facts(corpus: xr.Dataset, manifest: Manifest) -> dict[str, Any]:
    """Facts of an opened corpus by their names in the template ``card.md.jinja``; texts of strangers are as they are."""
    used = list(split_counts(corpus["split"]))
    fs = float(corpus["sample_rate"][0])
    pairs = np.unique(corpus["pair"].values) if "pair" in corpus else np.array([])
    history = corpus.attrs.get("history")
    return {
        "manifest": manifest,
        "origin": "; ".join(str(fact) for fact in (corpus.attrs.get("source"), history) if fact),
        "history": history,
        "records": corpus.sizes["record"],
        "seconds": corpus.sizes["elapsed_time"] / fs,
        "fs": fs,
        "channels": corpus["channel"].values.tolist(),
        "unusable": counts_in_words(manifest.signals),
        "clipped": clipped_records(corpus),
        "bearings": text_counts(corpus["bearing"].values.tolist()),
        "splits": SPLITS,
        "classes": _classes(corpus),
        "one_split": used[0] if len(used) == 1 else None,
        "shared": units_in_several_splits(corpus),
        "pairs": int((pairs >= 0).sum()),
        "ranges": ranges(corpus),
        "visible": fault_counts(corpus),
        "command": rebuilding(corpus, manifest),
        "variables": _variables(corpus),
    }


def _classes(corpus: xr.Dataset) -> list[tuple[str | int, ...]]:
    """Name of each class and of all, with the number of its records, recordings, specimens and rigs, and of records by split."""
    names = (*UNITS, "split")
    rows = by_class(corpus, names) | {"all": {name: corpus[name].values for name in names}}
    splits = {name: split_counts(row["split"]) for name, row in rows.items()}
    return [(name, *unit_counts(row), *(splits[name].get(split, 0) for split in SPLITS)) for name, row in rows.items()]


def ranges(corpus: xr.Dataset) -> dict[str, Any]:
    """Names of the classes; unit, and extents in each class, of the quantities that vary; the value of each that does not."""
    chosen = {
        name: variable[:].values  # of a copy, because the corpus would keep the values in memory
        for name in per_record(corpus)
        if (variable := corpus[name].variable).dtype.kind in "fiu"
        and variable.attrs.get("role") != "provenance"
        and "flag_values" not in variable.attrs
    }
    classes = by_class({"fault": corpus["fault"], **chosen}, chosen)
    vary, same = dict[str, tuple[str, ...]](), dict[str, str]()
    for name, values in chosen.items():
        ends, unit = extent(values), stored_unit(corpus[name].attrs)
        if ends is not None and ends[0] < ends[2]:
            vary[name] = unit, *(_cell(extent(columns[name])) for columns in classes.values())
        elif ends is not None and ends[2]:
            same[name] = f"{ends[2]:.6g} {unit}".removesuffix(" 1")
    return {"classes": list(classes), "vary": vary, "same": same}


def _cell(ends: tuple[float, ...] | None) -> str:
    """Cell of a class: its least, median and largest value."""
    if ends is None:
        return ""
    shown = [f"{value:.4g}" for value in ends]
    return shown[0] if shown[0] == shown[-1] else " / ".join(shown)


def rebuilding(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Words of the command that makes the corpus again; empty if none does."""
    if manifest.recipe_sha256 is not None:
        options = [(f"--{name}", str(value)) for name, value in (manifest.overrides or {}).items() if value is not None]
        return ["raceway", "generate", RECIPE_NAME, *(word for pair in options for word in pair), "-o", _NEW]
    if manifest.recordings is not None and manifest.importer is not None:
        window = corpus.sizes["elapsed_time"] / float(corpus["sample_rate"][0])
        return ["raceway", "import", manifest.importer, "SRC", "--window", f"{window:g}", "-o", _NEW]
    return []


def _variables(corpus: xr.Dataset) -> list[tuple[str, list[str]]]:
    """Name of every per-record variable, with its unit, role and meaning, by role and name."""
    facts = {
        name: [str(corpus[name].attrs.get(key, "")) for key in ("units", "role", "long_name")]
        for name in per_record(corpus)
    }
    places = {role: place for place, role in enumerate(ROLES)}
    return sorted(facts.items(), key=lambda item: (places.get(item[1][1], len(ROLES)), item[0]))
