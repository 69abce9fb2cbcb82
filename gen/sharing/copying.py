"""Records copied from one corpus into another: read as they are stored, with their recipes and the facts of the manifest."""

import hashlib
from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import (
    SIGNAL,
    Manifest,
    open_part,
    part_paths,
    plain_file,
    write_durably,
)
from gen.corpus.manifest_fields import Numbers
from gen.corpus.packed import packed_contents
from gen.corpus.record_hashes import RENUMBERED, stored_signal
from gen.corpus.schema import SIGNAL_DIMS

_BLOCK_SAMPLES = 10_000_000  # decoded at a time
_OWN_FACTS = {"raceway_format", "complete", "records", "signals", "index", "next_index", "parts", "publication"}
_OF_ONE_PART = ("failures",)


def facts_of(manifest: Manifest) -> dict[str, Any]:
    """Fields of a manifest that tell where its records come from, as they are stored in JSON."""
    facts = manifest.model_dump(mode="json", by_alias=True, exclude_unset=True)
    return {name: value for name, value in facts.items() if name not in _OWN_FACTS}


def stored_records(
    corpus: xr.Dataset, records: Sequence[int] | NDArray[np.intp], channels: Sequence[int]
) -> xr.Dataset:
    """Some records of an opened corpus as they are stored: a part for :func:`gen.corpus.write_part` without its global attributes.

    ``records`` are ascending; their variables are read together, and their signals in blocks.
    """
    some = corpus.isel(record=np.asarray(records))
    signal = (
        some[SIGNAL].variable if len(channels) == corpus.sizes["channel"] else some[SIGNAL].variable[:, [*channels]]
    )
    packing = {
        name: signal.encoding[name] for name in ("scale_factor", "add_offset", "_FillValue") if name in signal.encoding
    }
    counts = np.empty(signal.shape, np.dtype(signal.encoding["dtype"]).newbyteorder("="))
    size = max(1, _BLOCK_SAMPLES // max(1, counts[0].size))
    for first in range(0, len(counts), size):
        counts[first : first + size] = stored_signal(signal[first : first + size])[0]
    attributes = dict(signal.attrs) if counts.dtype.kind == "f" else signal.attrs | packing
    # h5py gives an axis with its byte order stated, of which netCDF4 warns
    time = some["elapsed_time"]
    some = some.assign_coords(elapsed_time=("elapsed_time", time.values.astype(np.float64), time.attrs))
    others = some.drop_vars(SIGNAL).isel(channel=[*channels]).load()
    return xr.Dataset({SIGNAL: (SIGNAL_DIMS, counts, attributes), **others.data_vars}, others.coords)


def joined(blocks: list[xr.Dataset]) -> xr.Dataset:
    """Records of several blocks, one after the other."""
    if len(blocks) == 1:
        return blocks[0]
    whole: Any = xr.concat(blocks, "record", data_vars="minimal", coords="minimal", compat="override", join="override")
    return whole


def part_attributes(directory: Path) -> dict[str, Any]:
    """Global attributes of the parts of a corpus, without those that belong to one part alone."""
    with open_part(part_paths(directory, "size")[0]) as part:
        return {str(name): value for name, value in part.attrs.items() if name not in _OF_ONE_PART}


def small_file(directory: Path, name: str) -> bytes | None:
    """Content of a file beside the parts of a corpus, in its folder or in a packed file; None if there is no such file."""
    if directory.is_file():
        return packed_contents(directory).files.get(name)
    return plain_file(directory, name).read_bytes() if (directory / name).exists() else None


def copy_recipes(source: Path, target: Path, names: Iterable[str | None]) -> None:
    """Copy ``recipe.yaml`` and the recipes with the given names from one corpus to another, as far as there are any."""
    for name in {"recipe.yaml", *names} - {None}:
        content = small_file(source, str(name))
        if content is not None:
            (target / str(name)).parent.mkdir(exist_ok=True)
            write_durably(content, target / str(name))


def parts_sha256(manifest: Manifest) -> str:
    """SHA-256 over those of all parts: the same for two copies of a corpus."""
    return hashlib.sha256("".join(row.sha256 for row in manifest.parts).encode()).hexdigest()


def records_of_origins(manifest: Manifest) -> list[slice]:
    """Records of each of the corpora that a corpus was merged from; all of them if it was not merged."""
    ends = np.cumsum([0, *(row.records for row in manifest.parts)])
    parts = np.cumsum([0, *(origin.parts for origin in manifest.origins)]) if manifest.origins else [0, -1]
    return [slice(int(ends[first]), int(ends[last])) for first, last in pairwise(parts)]


def in_floating_point(records: xr.Dataset) -> xr.Dataset:
    """Stored records with their signal in m s-2, in single precision; a missing sample is NaN."""
    signal = records[SIGNAL]
    if signal.dtype.kind == "f":
        return records
    missing = signal.values == signal.attrs["_FillValue"]
    scale = np.float32(signal.attrs["scale_factor"])  # double in older corpora; replay computes with the single one
    values = (signal.values * np.float64(scale)).astype(np.float32)
    values[missing] = np.nan
    packing = ("scale_factor", "add_offset", "_FillValue")
    attributes = {name: value for name, value in signal.attrs.items() if name not in packing}
    return records.assign({SIGNAL: (SIGNAL_DIMS, values, attributes)})


def renumbered(records: xr.Dataset, new: Numbers, old: Numbers | None = None) -> xr.Dataset:
    """Records to whose numbers ``new`` is added, in place of ``old``; negative numbers stand for none and stay."""
    changed = {}
    for name in set(RENUMBERED) & set(records.variables):
        values, move = records[name].values, getattr(new, name) - getattr(old or Numbers(), name)
        changed[name] = records[name].copy(data=np.where(values < 0, values, values + move).astype(values.dtype))
    return records.assign(changed)
