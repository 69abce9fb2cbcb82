"""Contents of a corpus on its data card: size, records by class and split, bearings, records that cannot be used."""

import numpy as np
import xarray as xr

from gen.corpus.card.markdown import plain_text, table
from gen.corpus.schema import FAULT_NAMES, SPLITS
from gen.corpus.signals import SignalCounts, clipped_records, counts_in_words

MOST_NAMES = 12  # bearings named on the card; the others are counted


def contents(corpus: xr.Dataset, signals: SignalCounts) -> list[str]:
    """Lines on the records of a corpus; ``signals`` counts those that cannot be used."""
    records, samples = corpus.sizes["record"], corpus.sizes["elapsed_time"]
    fs = float(corpus["sample_rate"][0])
    names = ", ".join(plain_text(name) for name in corpus["channel"].values)
    channels = "channel" if corpus.sizes["channel"] == 1 else "channels"
    return [
        f"{records} {'record' if records == 1 else 'records'} of {samples / fs:g} s at {fs:g} Hz, {channels} {names}, in m/s^2.",
        f"Records that cannot be used: {counts_in_words(signals)}.",
        *_clipped(corpus),
        "",
        f"Bearings: {_bearings(corpus)}.",
        *_classes(corpus),
        "",
        *_splits(corpus),
        *_pairs(corpus),
    ]


def _clipped(corpus: xr.Dataset) -> list[str]:
    counts = clipped_records(corpus)
    if counts is None:
        return []
    return [f"Records with a clipped sample: {', '.join(f'{name} {n}' for name, n in counts.items()) or 'none'}."]


def _bearings(corpus: xr.Dataset) -> str:
    names, counts = np.unique(corpus["bearing"].values.astype(str), return_counts=True)
    shown = [f"{plain_text(name)} ({n})" for name, n in zip(names[:MOST_NAMES], counts[:MOST_NAMES], strict=True)]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "") + ", with the number of records"


def _classes(corpus: xr.Dataset) -> list[str]:
    """Table of the classes: records, recordings, specimens, rigs, and records by split."""
    fault, split = corpus["fault"].values, corpus["split"].values
    units = ("recording", "specimen", "rig")
    numbers = {unit: corpus[unit].values for unit in units}
    rows = []
    for code, name in FAULT_NAMES.items():
        of_class = fault == code
        if of_class.any():
            counts = [int(of_class.sum()), *(np.unique(numbers[unit][of_class]).size for unit in units)]
            rows.append((name, *counts, *(int((of_class & (split == part)).sum()) for part in range(len(SPLITS)))))
    totals = [len(fault), *(np.unique(numbers[unit]).size for unit in units)]
    rows.append(("all", *totals, *(int((split == part).sum()) for part in range(len(SPLITS)))))
    return table(("fault", "records", "recordings", "specimens", "rigs", *SPLITS), rows, right=4 + len(SPLITS))


def _splits(corpus: xr.Dataset) -> list[str]:
    """Sentences on what the splits share: a machine or a bearing on both sides of a split makes scores too good."""
    used = np.unique(corpus["split"].values)
    if len(used) < 2:
        return [
            f"All records belong to the split {SPLITS[int(used[0])]}; divide them by `specimen` or `rig` for scores."
        ]
    shared = [unit for unit in ("rig", "specimen") if _in_several(corpus[unit].values, corpus["split"].values)]
    if not shared:
        return ["No rig and no specimen has records in two splits."]
    if shared == ["rig"]:
        return ["No specimen has records in two splits; rigs have."]
    return ["Specimens have records in several splits, so scores on these splits are too good; divide by `specimen`."]


def _in_several(units: np.ndarray, split: np.ndarray) -> bool:
    """Whether some unit has records in two splits."""
    both = np.unique(np.stack([units, split]), axis=1)
    return both.shape[1] > np.unique(units).size


def _pairs(corpus: xr.Dataset) -> list[str]:
    pairs = np.unique(corpus["pair"].values) if "pair" in corpus else np.array([])
    if not (pairs >= 0).any():
        return []
    groups = f"{(pairs >= 0).sum()} groups of records (`pair`) differ in the severity of their fault alone (`rung`)"
    return ["", f"{groups}; a specimen recorded before its damage counts as healthy too."]
