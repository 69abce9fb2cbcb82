"""What is in a corpus, finished or not: the facts behind ``raceway info``.

Manifest for the files, per-record variables for the content; no signal is read.
"""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gen.corpus import DRAWS, FAULTS, SPLITS, Manifest, open_corpus, open_part, plain_file, read_manifest

_TOLD = [
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
]


def describe(directory: Path) -> dict[str, Any]:
    """Facts about a corpus: where it comes from, how far it is, and what its records are.

    Raises
    ------
    CorpusError
        If it is no corpus, or a part is missing or altered.
    """
    manifest = read_manifest(directory)
    known = manifest.model_dump(exclude={"parts_", "complete", "records", "index", "signals"}, exclude_unset=True)
    about = {
        "corpus": directory,
        "complete": manifest.complete,
        "records": manifest.records,
        "parts": len(manifest.parts),
        "bytes": sum(path.stat().st_size for path in directory.rglob("*") if path.is_file()),
        "failures": [],
        "warnings": [],
        "skipped": [],
        "signals": manifest.signals._asdict(),
    }
    return about | known | (_content(_labels(directory, manifest)) if manifest.parts else {})


def _labels(directory: Path, manifest: Manifest) -> xr.Dataset:
    """The variables that ``info`` tells of; of an unfinished corpus those of the parts there are."""
    if manifest.complete:
        with open_corpus(directory, check="size") as corpus:
            return corpus.drop_vars(DRAWS, errors="ignore")[_TOLD].load()
    found = []
    for row in manifest.parts:
        with open_part(plain_file(directory, f"parts/{row.name}")) as part:
            found.append(part.drop_vars(DRAWS, errors="ignore")[_TOLD].load())
    whole: Any = xr.concat(found, "record", data_vars="minimal", coords="minimal", compat="override", join="override")
    return whole


def _content(labels: xr.Dataset) -> dict[str, Any]:
    rates = np.unique(labels["sample_rate"].values)
    return {
        "title": str(labels.attrs.get("title", "")),
        "channels": [str(name) for name in labels["channel"].values],
        "sample_rate": float(rates[0]) if len(rates) == 1 else rates.tolist(),
        "duration": labels.sizes["elapsed_time"] / float(rates[0]),
        "samples": labels.sizes["elapsed_time"],
        "classes": _named_counts(labels["fault"].values, FAULTS),
        "splits": _named_counts(labels["split"].values, SPLITS),
        "bearings": _counts(labels["bearing"].values),
        "rigs": _distinct(labels["rig"].values),
        "specimens": _distinct(labels["rig"].values, labels["specimen"].values),
        "recordings": _distinct(labels["rig"].values, labels["specimen"].values, labels["recording"].values),
        "shaft_rate": _range(labels["shaft_rate"].values),
        "load": _range(labels["load"].values),
    }


def _named_counts(codes: np.ndarray, names: tuple[str, ...]) -> dict[str, int]:
    return {name: int((codes == code).sum()) for code, name in enumerate(names) if (codes == code).any()}


def _counts(values: np.ndarray) -> dict[str, int]:
    names, numbers = np.unique(values.astype(str), return_counts=True)
    return dict(zip(names.tolist(), numbers.tolist(), strict=True))


def _distinct(*keys: np.ndarray) -> int:
    return np.unique(np.stack(keys), axis=1).shape[1]


def _range(values: np.ndarray) -> list[float] | None:
    """Smallest and largest value, None if none is known."""
    known = values[np.isfinite(values)]
    return [float(known.min()), float(known.max())] if known.size else None
