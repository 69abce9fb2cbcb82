"""All per-record variables of a corpus in one file: ``index.nc`` of a folder without the signals, or the single file with them.

Both have the facts of the manifest, the recipe and the attributes of a published corpus as global attributes.
"""

import shutil
from collections.abc import Iterable, Mapping, Sequence
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any

import h5py
import xarray as xr

from gen.corpus.acdd import publication_attributes
from gen.corpus.disk import append_checksum, remove_checksum, whole_or_not_at_all
from gen.corpus.lazy import open_part, open_records, stored_records
from gen.corpus.manifest import (
    INDEX_NAME,
    Check,
    corpus_files,
    facts_as_attributes,
    manifest_of,
    read_manifest,
)
from gen.corpus.part import PartRow, write_netcdf, write_texts
from gen.corpus.schema import (
    RECIPE_TEXT,
    SIGNAL,
    add_class_names,
    operating_problems,
    records_in_memory,
    schema_problems,
)
from gen.corpus.simulated import LIFE, SIMULATED
from gen.corpus.slices import codec_of
from gen.corpus.trust import LIBRARY_LOCK
from gen.support.errors import CorpusError

_OF_CORPUS = ("Conventions", "raceway_format", "history", "source")


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
        _write_parts(directory, rows, temporary, attributes, without=(SIGNAL,))


def join_parts(directory: Path, rows: Sequence[PartRow], attributes: Mapping[str, str], file: Path) -> None:
    """Write all parts of a folder into a single file, atomically.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    with whole_or_not_at_all(file) as temporary:
        _write_parts(directory, rows, temporary, attributes)


def _write_parts(
    directory: Path, rows: Sequence[PartRow], path: Path, attributes: Mapping[str, str], without: Sequence[str] = ()
) -> None:
    """Write the variables of the parts one after the other into a new file, those of one part at a time."""
    paths, counts = [directory / "parts" / row.name for row in rows], [row.records for row in rows]
    with stored_records(paths, paths, counts) as records:
        columns = {str(name): variable for name, variable in records.variables.items() if name not in without}
        kept = {name: records.attrs[name] for name in _OF_CORPUS if name in records.attrs}
        blocks = [slice(first, stop) for first, stop in pairwise(accumulate(counts, initial=0))]
        write_netcdf(columns, {**kept, **attributes}, path, codec_of(paths[0]), blocks)
    append_checksum(path)


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
        write_texts(temporary, new)
        append_checksum(temporary)
