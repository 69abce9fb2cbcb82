"""The files of a corpus beside its parts, written when all parts are there: index and manifest, or one file of all parts."""

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any

from gen.corpus.disk import (
    CARD_NAME,
    CROISSANT_NAME,
    INDEX_NAME,
    MANIFEST_NAME,
    RECIPE_NAME,
    append_checksum,
    remove_temporary_files,
    whole_or_not_at_all,
)
from gen.corpus.lazy import stored_records
from gen.corpus.manifest import Manifest, facts_as_attributes, manifest_of_parts, recipe_text, write_manifest
from gen.corpus.part import PartRow, write_netcdf
from gen.corpus.schema import SIGNAL
from gen.corpus.trust import codec_of

_OF_PARTS = ("Conventions", "raceway_format", "history", "source")


def finish_corpus(
    directory: Path,
    rows: Iterable[PartRow],
    file: Path | None = None,
    attributes: Callable[[Manifest], Mapping[str, str]] = lambda _: {},
    **facts: Any,
) -> Manifest:
    """Write index and manifest over the finished parts of a folder, or all parts into one ``file``; atomically, and manifest last.

    ``facts`` are further fields of the manifest, and ``attributes`` gives global attributes of the index or file beside them, such as
    those of publication. A data card with its ``croissant.json`` describes the corpus as it was and is removed;
    ``raceway.describe`` writes both. The same parts and facts give the same bytes.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    manifest = manifest_of_parts(rows, facts)
    with whole_or_not_at_all(file or directory / INDEX_NAME) as temporary:
        _join_parts(directory, manifest, temporary, attributes(manifest), without=() if file else (SIGNAL,))
    if file is None:
        write_manifest(directory, manifest.content)
        if (directory / CROISSANT_NAME).exists():  # a README.md alone can be one of the user
            for name in (CARD_NAME, CROISSANT_NAME):
                (directory / name).unlink(missing_ok=True)
    return manifest


def _join_parts(
    directory: Path, manifest: Manifest, path: Path, attributes: Mapping[str, str], without: tuple[str, ...]
) -> None:
    """Write the variables of the parts one after the other into a new file, those of one part at a time."""
    paths, counts = [directory / "parts" / row.name for row in manifest.parts], [row.records for row in manifest.parts]
    with stored_records(paths, paths, counts) as records:
        columns = {str(name): variable for name, variable in records.variables.items() if name not in without}
        blocks = [slice(first, stop) for first, stop in pairwise(accumulate(counts, initial=0))]
        kept = {name: records.attrs[name] for name in _OF_PARTS if name in records.attrs}
        facts = facts_as_attributes(manifest.content, recipe_text(directory))
        write_netcdf(columns, {**kept, **facts, **attributes}, path, codec_of(paths[0]), blocks)
    append_checksum(path)


def remove_parts(directory: Path, names: Iterable[str]) -> None:
    """Remove the parts of a finished single file, with the manifest and recipe beside them, and the folder if it holds nothing else."""
    remove_temporary_files(directory)
    parts = directory / "parts"
    for file in (*(parts / name for name in names), directory / RECIPE_NAME, directory / MANIFEST_NAME):
        file.unlink(missing_ok=True)
    for folder in (parts, directory):
        with suppress(OSError):  # a file of the user is in it
            folder.rmdir()
