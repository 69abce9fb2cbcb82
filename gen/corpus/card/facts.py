"""Facts of a corpus for its data card: counts by class and split, ranges, meanings, the command that makes it again."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
import xarray as xr

from gen.corpus.choice import per_record
from gen.corpus.hdf5 import LIBRARY_LOCK, own_dataset
from gen.corpus.manifest import RECIPE_NAME, Manifest
from gen.corpus.schema import FAULT_NAMES, ROLES, SIGNAL, SPLITS
from gen.corpus.signals import clipped_records, counts_in_words
from gen.corpus.visible import fault_counts

MOST_NAMES = 12  # bearings named on the card; the others are counted
_NEW = "../again"
_ZSTD = 32015  # number of the filter, registered with The HDF Group


def card_facts(corpus: xr.Dataset, manifest: Manifest) -> dict[str, Any]:
    """Facts of an opened corpus by their names in the template ``card.md.jinja``; texts of strangers are as they are."""
    split = corpus["split"].values
    used = np.unique(split)
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
        "bearings": _bearings(corpus),
        "splits": SPLITS,
        "classes": list(_classes(corpus)),
        "one_split": SPLITS[int(used[0])] if len(used) == 1 else None,
        "shared": [unit for unit in ("rig", "specimen") if _in_several(corpus[unit].values, split)],
        "pairs": int((pairs >= 0).sum()),
        "ranges": ranges(corpus),
        "visible": fault_counts(corpus),
        "command": rebuilding(corpus, manifest),
        "variables": _variables(corpus),
    }


def _bearings(corpus: xr.Dataset) -> str:
    names, counts = np.unique(corpus["bearing"].values.astype(str), return_counts=True)
    shown = [f"{name} ({n})" for name, n in zip(names[:MOST_NAMES], counts[:MOST_NAMES], strict=True)]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def _classes(corpus: xr.Dataset) -> Iterator[tuple[str | int, ...]]:
    """Name of each class and of all, with the number of its records, recordings, specimens and rigs, and of records by split."""
    fault, split = corpus["fault"].values, corpus["split"].values
    units = [corpus[unit].values for unit in ("recording", "specimen", "rig")]
    groups = {name: fault == code for code, name in FAULT_NAMES.items()} | {"all": np.ones(len(fault), bool)}
    for name, chosen in groups.items():
        if chosen.any():
            counts = (np.unique(numbers[chosen]).size for numbers in units)
            yield name, int(chosen.sum()), *counts, *(int((chosen & (split == k)).sum()) for k in range(len(SPLITS)))


def _in_several(units: np.ndarray, split: np.ndarray) -> bool:
    """Whether some unit has records in two splits: then scores are too good."""
    both = np.unique(np.stack([units, split]), axis=1)
    return both.shape[1] > np.unique(units).size


def ranges(corpus: xr.Dataset) -> dict[str, Any]:
    """Names of the classes; unit, and extents in each class, of the quantities that vary; the value of each that does not."""
    chosen = {
        name: variable[:].values.astype(float)  # of a copy, because the corpus would keep the values in memory
        for name in per_record(corpus)
        if (variable := corpus[name].variable).dtype.kind in "fiu"
        and variable.attrs.get("role") != "provenance"
        and "flag_values" not in variable.attrs
    }
    values = pd.DataFrame(chosen).replace([np.inf, -np.inf], np.nan).dropna(axis="columns", how="all")
    units = {name: _unit(corpus[name].variable) for name in values}
    vary = values.nunique() > 1
    fault = corpus["fault"].values
    by_class = values.groupby(fault)
    extents = {name: by_class[name].agg(["min", "median", "max"]).to_numpy().tolist() for name in values.columns[vary]}
    same = values.loc[:, ~vary].max()  # of equal values, some of which are not known
    return {
        "classes": [FAULT_NAMES.get(code, str(code)) for code in np.unique(fault).tolist()],
        "vary": {name: (units[name], *map(_extent, of_one)) for name, of_one in extents.items()},
        "same": {name: f"{value:.6g} {units[name]}".removesuffix(" 1") for name, value in same.items() if value},
    }


def _unit(variable: xr.Variable) -> str:
    """Unit in a table; that of a level in decibels is stored as 1, because CF has no unit for it."""
    in_decibels = "decibels" in str(variable.attrs.get("long_name"))
    return "dB" if in_decibels else str(variable.attrs.get("units", ""))


def _extent(values: list[float]) -> str:
    """Cell of a class, of its least, median and largest value."""
    if np.isnan(values[0]):
        return ""
    shown = [f"{value:.4g}" for value in values]
    return shown[0] if shown[0] == shown[-1] else " / ".join(shown)


def rebuilding(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Words of the command that makes the corpus again; empty if none does."""
    if manifest.recipe_sha256 is not None:
        overrides = manifest.overrides.model_dump() if manifest.overrides is not None else {}
        given = [(f"--{name}", str(overrides[name])) for name in ("seed", "records") if overrides.get(name) is not None]
        return ["raceway", "generate", RECIPE_NAME, *(word for pair in given for word in pair), "-o", _NEW]
    if manifest.recordings is not None and manifest.importer is not None:
        window = corpus.sizes["elapsed_time"] / float(corpus["sample_rate"][0])
        return ["raceway", "import", manifest.importer, "SRC", "--window", f"{window:g}", "-o", _NEW]
    return []


def needs_plugin(part: Path) -> bool:
    """Whether the signals of a file can be read with the zstd filter of HDF5 alone."""
    with LIBRARY_LOCK, h5py.File(part, "r", locking=False) as file:
        return own_dataset(file, SIGNAL).id.get_create_plist().get_filter_by_id(_ZSTD) is not None


def _variables(corpus: xr.Dataset) -> list[tuple[str, list[str]]]:
    """Name of every per-record variable, with its unit, role and meaning, by role and name."""
    facts = {
        name: [str(corpus[name].attrs.get(key, "")) for key in ("units", "role", "long_name")]
        for name in per_record(corpus)
    }
    places = {role: place for place, role in enumerate(ROLES)}
    return sorted(facts.items(), key=lambda item: (places.get(item[1][1], len(ROLES)), item[0]))
