"""The corpus as one file: ``corpus.nc`` over the parts, and the manifest that says whether they are all there and unaltered.

``corpus.nc`` holds every per-record variable and, for the signal, an HDF5 virtual dataset over the parts, so that any netCDF-4
reader sees one file. HDF5 reads a missing part as fill values without an error; therefore :func:`open_corpus` asks the manifest first.
"""

import json
import re
from pathlib import Path
from typing import Any, Literal

import h5py
import netCDF4
import numpy as np
import xarray as xr

from gen.corpus.part import PartRow, open_part, sha256, whole_or_not_at_all, write_text_durably
from gen.corpus.schema import FORMAT, MISSING_COUNT, SIGNAL, schema_problems
from gen.corpus.signals import SignalCounts, summed
from gen.errors import CorpusError

_PART_NAME = re.compile(r"part-\d{5,}\.nc")


def write_manifest(directory: Path, rows: list[PartRow], *, complete: bool, **facts: Any) -> None:
    """Write ``manifest.json``: the parts so far, whether they are all, and ``facts`` such as recipe hash and versions."""
    manifest = {
        "raceway_format": FORMAT,
        "complete": complete,
        "records": sum(row.records for row in rows),
        "signals": summed(row.signals for row in rows)._asdict(),
        **facts,
        "parts": [row._asdict() | {"signals": row.signals._asdict()} for row in rows],
    }
    write_text_durably(json.dumps(manifest, indent=1) + "\n", directory / "manifest.json")


def read_manifest(directory: Path) -> dict[str, Any]:
    """Read and check ``manifest.json``; its part names cannot lead out of the corpus.

    Raises
    ------
    CorpusError
        If it is missing, unreadable, of another format version or names a part that is no part.
    """
    path = directory / "manifest.json"
    if not directory.is_dir():
        raise CorpusError(
            f"{directory}: no such folder; give the folder of a corpus, the one that holds manifest.json."
        )
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
        rows = [
            PartRow(
                row["name"],
                int(row["records"]),
                int(row["bytes"]),
                str(row["sha256"]),
                SignalCounts(**{kind: int(n) for kind, n in row.get("signals", {}).items()}),
            )
            for row in manifest["parts"]
        ]
    except FileNotFoundError:
        raise CorpusError(
            f"{directory}: holds no manifest.json, so it is no corpus; make one with raceway generate."
        ) from None
    except (ValueError, TypeError, KeyError, AttributeError, UnicodeDecodeError) as error:
        raise CorpusError(f"{path}: not a corpus manifest ({error!r}); generate or copy the corpus again.") from error
    if manifest.get("raceway_format") != FORMAT:
        found = manifest.get("raceway_format")
        raise CorpusError(f"{path}: corpus format {found!r}, this version of raceway reads format {FORMAT}.")
    if not isinstance(manifest.get("complete"), bool) or not isinstance(manifest.get("records"), int):
        raise CorpusError(f"{path}: does not say how complete the corpus is; generate or copy the corpus again.")
    for row in rows:
        if not isinstance(row.name, str) or not _PART_NAME.fullmatch(row.name):
            raise CorpusError(
                f"{path}: {row.name!r} is not the name of a part (part-00000.nc, ...); do not trust this corpus."
            )
    return manifest | {"parts": rows}


def part_paths(directory: Path | str, check: Literal["sha256", "size"] = "sha256") -> list[Path]:
    """Paths of all parts of a finished corpus, each there and unaltered.

    ``check="size"`` looks at sizes only: for a corpus too large to be hashed again.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or a part is missing or altered.
    """
    directory = Path(directory)
    manifest = read_manifest(directory)
    if not manifest["complete"]:
        raise CorpusError(f"{directory}: unfinished; the raceway generate command that began it completes it.")
    problems = list(part_problems(directory, manifest["parts"], check))
    if problems:
        raise CorpusError(problems[0])
    return [directory / "parts" / row.name for row in manifest["parts"]]


def part_problems(directory: Path, rows: list[PartRow], check: Literal["sha256", "size"]) -> list[str]:
    """Missing and altered parts, one sentence each."""
    problems: list[str] = []
    for row in rows:
        path = directory / "parts" / row.name
        if not path.is_file():
            problems.append(f"{path}: missing; copy it again, or run the command that made the corpus again.")
        elif path.stat().st_size != row.bytes or (check == "sha256" and sha256(path) != row.sha256):
            problems.append(
                f"{path}: altered, it is not the file the manifest names; copy it again or delete it and make the corpus again."
            )
    return problems


def open_corpus(directory: Path | str, check: Literal["sha256", "size"] = "sha256") -> xr.Dataset:
    """Open a corpus as one dataset, read when touched.

    Parameters
    ----------
    directory : path
        The folder that holds ``corpus.nc``.
    check : {"sha256", "size"}
        How each part is compared with the manifest before anything is read.

    Returns
    -------
    Dataset
        ``acceleration (record, channel, elapsed_time)`` [m s-2] and the variables of :data:`gen.corpus.SCHEMA`.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or a part is missing, altered or reached outside the folder.
    """
    directory = Path(directory)
    names = {f"parts/{path.name}" for path in part_paths(directory, check)}
    path = directory / "corpus.nc"
    try:
        with h5py.File(path) as file:
            signal: Any = file[SIGNAL]
            sources = {source.file_name for source in signal.virtual_sources()} if signal.is_virtual else {"no part"}
    except (OSError, KeyError, RuntimeError) as error:
        raise CorpusError(f"{path}: not a corpus index ({error}); make or copy the corpus again.") from error
    if sources != names:
        foreign = min(sources ^ names)
        raise CorpusError(f"{path}: index and manifest disagree about {foreign}; do not trust this corpus.")
    return xr.open_dataset(path, engine="netcdf4", decode_times=False)


def write_index(directory: Path, rows: list[PartRow]) -> None:
    """Write ``corpus.nc`` over the finished parts, whole or not at all.

    Raises
    ------
    CorpusError
        If the disk refuses the file, with the reason it gives.
    """
    with whole_or_not_at_all(directory / "corpus.nc") as temporary:
        _write_variables(directory, rows, temporary)
        _write_virtual_signal(directory, rows, temporary)


def _write_variables(directory: Path, rows: list[PartRow], path: Path) -> None:
    """Copy every variable but the signal, part by part; text is as wide as its longest in any part."""
    lengths: dict[str, int] = {}
    for row in rows:
        with netCDF4.Dataset(directory / "parts" / row.name) as part:
            for name, dimension in part.dimensions.items():
                lengths[name] = max(lengths.get(name, 0), dimension.size)
    lengths["record"] = sum(row.records for row in rows)
    with netCDF4.Dataset(path, "w", format="NETCDF4") as index:
        first = 0
        for row in rows:
            with netCDF4.Dataset(directory / "parts" / row.name) as part:
                part.set_auto_maskandscale(False)
                part.set_auto_chartostring(False)
                if first == 0:
                    _declare_like(part, index, lengths)
                for name, variable in part.variables.items():
                    if name != SIGNAL and variable.dimensions[0] == "record":
                        values = variable[:]
                        window = (slice(first, first + row.records), *map(slice, values.shape[1:]))
                        index[name][window] = values
            first += row.records


def _declare_like(part: netCDF4.Dataset, index: netCDF4.Dataset, lengths: dict[str, int]) -> None:
    index.setncatts({name: part.getncattr(name) for name in part.ncattrs()})
    for name, length in lengths.items():
        index.createDimension(name, length)
    for name, variable in part.variables.items():
        if name == SIGNAL:
            continue
        copy = index.createVariable(name, variable.dtype, variable.dimensions, fill_value=False)
        copy.set_auto_maskandscale(False)
        copy.set_auto_chartostring(False)
        copy.setncatts({key: variable.getncattr(key) for key in variable.ncattrs()})
        if "record" not in variable.dimensions:
            copy[:] = variable[:]


def _write_virtual_signal(directory: Path, rows: list[PartRow], path: Path) -> None:
    with h5py.File(directory / "parts" / rows[0].name) as part:
        model: Any = part[SIGNAL]
        shape, dtype = model.shape, model.dtype
        attributes = {
            key: model.attrs[key] for key in model.attrs if key not in ("DIMENSION_LIST", "_Netcdf4Coordinates")
        }
    layout = h5py.VirtualLayout((sum(row.records for row in rows), *shape[1:]), dtype)
    first = 0
    for row in rows:
        source = h5py.VirtualSource(f"parts/{row.name}", SIGNAL, (row.records, *shape[1:]), dtype)
        layout[first : first + row.records] = source
        first += row.records
    with h5py.File(path, "r+") as index:
        fill = MISSING_COUNT if np.issubdtype(dtype, np.integer) else np.nan
        signal = index.create_virtual_dataset(SIGNAL, layout, fillvalue=fill)
        for key, value in attributes.items():
            signal.attrs[key] = value
        for axis, name in enumerate(("record", "channel", "elapsed_time")):
            signal.dims[axis].attach_scale(index[name])


def validate_corpus(directory: Path | str) -> list[str]:
    """Everything that is wrong with a corpus, one sentence each; an empty list if nothing is.

    Looks at the manifest, the bytes of every part, the format of every part, the values of the signal, and whether
    ``corpus.nc`` says the same as the parts.
    """
    directory = Path(directory)
    try:
        manifest = read_manifest(directory)
        problems = part_problems(directory, manifest["parts"], "sha256")
        if problems:
            return problems
        with open_corpus(directory, check="size") as index:
            first = 0
            for row in manifest["parts"]:
                with open_part(directory / "parts" / row.name) as part:
                    here = index.isel(record=slice(first, first + row.records))
                    problems += [
                        f"{directory / 'parts' / row.name}: {text}" for text in _part_content_problems(part, here)
                    ]
                first += row.records
            if index.sizes["record"] != first:
                problems.append(f"{directory / 'corpus.nc'}: {index.sizes['record']} records, the parts hold {first}.")
    except CorpusError as error:
        return [str(error)]
    return problems


def _part_content_problems(part: xr.Dataset, index: xr.Dataset) -> list[str]:
    problems = schema_problems(part)
    if problems:
        return problems
    if set(part.variables) != set(index.variables) or part.sizes != index.sizes:
        return ["corpus.nc has other variables or sizes; make or copy the corpus again."]
    signal = part[SIGNAL].values
    for record in np.flatnonzero(~np.isfinite(signal).all(axis=(1, 2))):
        problems.append(f"record {record} of the part has samples that are not finite.")
    for name in part.variables:
        if not part.variables[name].identical(index.variables[name]):
            problems.append(f"{name} differs from corpus.nc; make or copy the corpus again.")
    return problems
