"""All per-record variables of a corpus in one file: ``index.nc`` of a folder without the signals, or the single file with them.

Both have the facts of the manifest, the recipe and the attributes of a published corpus as global attributes.
"""

import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import h5py
import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.acdd import publication_attributes
from gen.corpus.blocks import stored_columns
from gen.corpus.codecs import CODECS
from gen.corpus.files import append_checksum, remove_checksum, whole_or_not_at_all
from gen.corpus.hdf5 import LIBRARY_LOCK
from gen.corpus.layout import is_bare_dimension
from gen.corpus.manifest import (
    INDEX_NAME,
    Check,
    corpus_files,
    facts_as_attributes,
    manifest_of,
    read_manifest,
)
from gen.corpus.part import PartRow
from gen.corpus.reading import open_part, open_records
from gen.corpus.schema import (
    RECIPE_TEXT,
    SIGNAL,
    add_class_names,
    operating_problems,
    records_in_memory,
    schema_problems,
)
from gen.corpus.simulated import LIFE, SIMULATED
from gen.corpus.unicode_text import set_attributes, write_unicode
from gen.support.errors import CorpusError

_OF_CORPUS = ("Conventions", "raceway_format", "history", "source")
_CHUNK_RECORDS = 256  # records whose text forms one chunk
_COPIED_BYTES = 16_000_000  # of the variables of some parts, in memory at a time


def open_corpus(path: Path | str | xr.Dataset, check: Check = "sha256") -> xr.Dataset:
    """Open a corpus as one dataset, which is read lazily.

    Parameters
    ----------
    path : path
        Folder of a corpus, or a corpus in a single file. Records in memory, of :func:`gen.records` or chosen from an open corpus, are
        returned as they are.
    check : {"sha256", "size"}
        Comparison of each file with its hash, or with its size only, before anything is read.

    Returns
    -------
    Dataset
        ``acceleration (record, channel, elapsed_time)`` [m s-2] and the variables of :data:`gen.corpus.SCHEMA`, with the classes in words
        as ``fault_name`` and ``split_name``: ``corpus.sel(record=corpus.fault_name == "inner")``. It can be pickled, and chunked for dask
        with ``.chunk({"record": n})``.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, one of its files is missing, altered or outside its folder, or a variable is not in the format.
    """
    if not isinstance(path, Path | str):
        records = records_in_memory(path)
        for problem in operating_problems({name: records[name].values for name in ("sample_rate", "shaft_rate")}):
            raise CorpusError(f"{corpus_name(path)}: {problem}")
        add_class_names(records)
        return records
    path = Path(path)
    files = corpus_files(path, check)
    opened = open_part(path) if path.is_file() else _open_folder(path, files)
    for problem in schema_problems(opened, SIMULATED + LIFE):
        opened.close()
        raise CorpusError(f"{path}: {problem}")
    add_class_names(opened)
    return opened


def corpus_name(corpus: Path | str | xr.Dataset) -> str:
    """Path of a corpus, or the title of records in memory, with which a sentence begins."""
    return f"{corpus.attrs.get('title', 'records')}" if isinstance(corpus, xr.Dataset) else f"{corpus}"


def _open_folder(path: Path, files: Sequence[Path]) -> xr.Dataset:
    """Records of a folder; CorpusError if its index is that of other parts."""
    manifest = read_manifest(path)
    opened = open_records(path / INDEX_NAME, files, [row.records for row in manifest.parts])
    if opened.attrs.get("parts_sha256") != manifest.parts_sha256:
        opened.close()
        raise CorpusError(
            f"{path / INDEX_NAME}: is the index of other parts than manifest.json lists; copy the corpus again."
        )
    return opened


def corpus_attributes(content: Mapping[str, Any], recipe: str | None, place: Path) -> dict[str, str]:
    """Global attributes of ``index.nc`` and of a single file beside those of the parts, from the contents of the manifest."""
    texts = {} if recipe is None else {RECIPE_TEXT: recipe}
    return publication_attributes(manifest_of(content, place)) | facts_as_attributes(content) | texts


def write_index(directory: Path, rows: Sequence[PartRow], attributes: Mapping[str, str]) -> None:
    """Write ``index.nc`` over the finished parts atomically; the same parts and attributes give the same bytes.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    with whole_or_not_at_all(directory / INDEX_NAME) as temporary:
        _write_variables(directory, rows, temporary, attributes, signal=False)
        append_checksum(temporary)


def join_parts(directory: Path, rows: Sequence[PartRow], attributes: Mapping[str, str], file: Path) -> None:
    """Write all parts of a folder into a single file, atomically; their compressed signals are copied as they are.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    with whole_or_not_at_all(file) as temporary:
        _write_variables(directory, rows, temporary, attributes, signal=True)
        with LIBRARY_LOCK, h5py.File(temporary, "r+") as joined:
            signal, first = joined[SIGNAL], 0
            for row in rows:
                with h5py.File(directory / "parts" / row.name, "r", locking=False) as part:
                    _copy_chunks(part[SIGNAL], signal, first)
                first += row.records
        append_checksum(temporary)


def _copy_chunks(stored: Any, joined: Any, first: int) -> None:
    """Copy compressed records behind ``first`` others."""
    for record, channel in np.ndindex(stored.shape[:2]):
        filters_left_out, chunk = stored.id.read_direct_chunk((record, channel, 0))
        joined.id.write_direct_chunk((first + record, channel, 0), chunk, filters_left_out)


def rewrite_attributes(file: Path, old: Iterable[str], new: Mapping[str, str]) -> None:
    """Replace the ``old`` global attributes of a single file by ``new`` ones, in a copy that takes its place.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    with whole_or_not_at_all(file) as temporary:
        shutil.copyfile(file, temporary)
        remove_checksum(temporary)
        with LIBRARY_LOCK, h5py.File(temporary, "r+") as changed:
            for name in {*old, *new} & set(changed.attrs):
                del changed.attrs[name]
            write_unicode(changed, new)
        append_checksum(temporary)


def _write_variables(
    directory: Path, rows: Sequence[PartRow], path: Path, attributes: Mapping[str, str], *, signal: bool
) -> None:
    """Write the variables of the parts one after the other into a new file; the signal is only declared.

    The width of a text is that of the longest in any part. The parts are read with h5py, and written ``_COPIED_BYTES`` at a time: writing
    the variables of each part on their own takes twice as long.
    """
    paths = [directory / "parts" / row.name for row in rows]
    with LIBRARY_LOCK:
        with netCDF4.Dataset(paths[0]) as first, netCDF4.Dataset(path, "w", format="NETCDF4") as file:
            first.set_auto_maskandscale(False)
            first.set_auto_chartostring(False)
            kept = {name: first.getncattr(name) for name in _OF_CORPUS if name in first.ncattrs()}
            beyond_ascii = set_attributes(file, {**kept, **attributes})
            lengths = {name: dimension.size for name, dimension in first.dimensions.items()}
            lengths |= _widths(paths) | {"record": sum(row.records for row in rows)}
            _declare_like(first, file, lengths, signal=signal)
            start = 0
            for block in _blocks(paths):
                for name, values in block.items():
                    file[name][(slice(start, start + len(values)), *map(slice, values.shape[1:]))] = values
                start += len(block["rig"])
        with h5py.File(path, "r+") as file:
            write_unicode(file, beyond_ascii)


def _widths(paths: Sequence[Path]) -> dict[str, int]:
    """Largest width of each text in the parts, by the name of its dimension."""
    widths: dict[str, int] = {}
    for path in paths:
        with h5py.File(path, "r", locking=False) as part:
            for name in filter(lambda name: name.endswith("_length"), map(str, part)):
                dimension: Any = part[name]
                if is_bare_dimension(dimension):
                    widths[name] = max(widths.get(name, 0), dimension.shape[0])
    return widths


def _blocks(paths: Sequence[Path]) -> Iterator[dict[str, NDArray[Any]]]:
    """Values of each variable over as many consecutive parts as fill ``_COPIED_BYTES``."""
    block: list[dict[str, NDArray[Any]]] = []
    size = 0
    for path in paths:
        block.append(stored_columns(path))
        size += sum(values.nbytes for values in block[-1].values())
        if size > _COPIED_BYTES:
            yield _join(block)
            block, size = [], 0
    if block:
        yield _join(block)


def _join(block: Sequence[Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    """Values of consecutive parts one after the other; text is filled up to the width of the widest."""
    joined: dict[str, NDArray[Any]] = {}
    for name, values in block[0].items():
        rows = [columns[name] for columns in block]
        if values.ndim == 1:
            joined[name] = np.concatenate(rows)
            continue
        width = max(row.shape[1] for row in rows)
        padded = [np.pad(row.view(np.uint8), ((0, 0), (0, width - row.shape[1]))) for row in rows]
        joined[name] = np.concatenate(padded).view("S1")
    return joined


def _declare_like(part: netCDF4.Dataset, file: netCDF4.Dataset, lengths: dict[str, int], *, signal: bool) -> None:
    """Declare the variables of a part in a file with other lengths of dimensions, and copy the axes."""
    for name, length in lengths.items():
        file.createDimension(name, length)
    for name, variable in part.variables.items():
        if name == SIGNAL and not signal:
            continue
        attributes = {key: variable.getncattr(key) for key in variable.ncattrs()}
        storage: dict[str, Any] = {"fill_value": attributes.pop("_FillValue", False)}
        if name == SIGNAL:
            filters = variable.filters()
            codec = {"compression": "zstd"} if filters.get("zstd") else {"zlib": bool(filters["zlib"])}
            storage |= {"chunksizes": variable.chunking(), "shuffle": bool(filters["shuffle"]), **codec}
            storage |= {"complevel": filters["complevel"]}
        elif name == "elapsed_time":
            storage |= CODECS["zlib"].options
        elif variable.dtype == "S1" and variable.dimensions[0] == "record":  # drawn values repeat from record to record
            shape = [lengths[dimension] for dimension in variable.dimensions]
            storage |= {"zlib": True, "complevel": 1, "chunksizes": (min(_CHUNK_RECORDS, shape[0]), shape[1])}
        copy = file.createVariable(name, variable.dtype, variable.dimensions, **storage)
        copy.set_auto_maskandscale(False)
        copy.set_auto_chartostring(False)
        copy.setncatts(attributes)
        if "record" not in variable.dimensions:
            copy[:] = variable[:]
