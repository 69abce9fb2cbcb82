"""The files of a finished corpus beside its parts: index, manifest, data card; one file of all parts; a change of the publication."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from gen.corpus.acdd import publication_attributes
from gen.corpus.card.page import check_card, write_card
from gen.corpus.croissant import CROISSANT_NAME, write_croissant
from gen.corpus.files import remove_left_behind, remove_left_behind_of
from gen.corpus.index import corpus_attributes, join_parts, rewrite_attributes, write_index
from gen.corpus.locking import lock
from gen.corpus.manifest import (
    INDEX_NAME,
    MANIFEST_NAME,
    RECIPE_NAME,
    corpus_files,
    facts_of_parts,
    read_manifest,
    recipe_text,
    write_manifest,
)
from gen.corpus.part import PartRow
from gen.corpus.publication import Publication, read_publication
from gen.corpus.signals import SignalCounts


def finish_corpus(directory: Path, rows: Iterable[PartRow], **facts: Any) -> SignalCounts:
    """Write index, manifest and data card over finished parts; returns the counts of records that cannot be used.

    ``facts`` are further fields of the manifest.
    """
    rows = list(rows)
    content = facts_of_parts(rows, facts)
    write_index(directory, rows, corpus_attributes(content, recipe_text(directory), directory))
    write_manifest(directory, content)
    write_card(directory)
    write_croissant(directory)
    return SignalCounts(**content["signals"])


def finish_file(directory: Path, rows: Iterable[PartRow], file: Path, **facts: Any) -> SignalCounts:
    """Write all parts of a folder into one file; returns the counts of records that cannot be used."""
    rows = list(rows)
    content = facts_of_parts(rows, facts)
    join_parts(directory, rows, corpus_attributes(content, recipe_text(directory), directory), file)
    return SignalCounts(**content["signals"])


def remove_temporary_files(directory: Path) -> None:
    """Remove temporary files that killed calls have left beside the files of a corpus; no other process may be writing into it."""
    for name in (MANIFEST_NAME, INDEX_NAME, "README.md", "card.json", RECIPE_NAME, CROISSANT_NAME):
        remove_left_behind(directory, name)
    remove_left_behind(directory / "parts", "part-*.nc")
    remove_left_behind(directory / "pictures", "*.png")


def remove_parts(directory: Path, names: Iterable[str]) -> None:
    """Remove the parts of a finished single file, with the manifest and recipe beside them, and the folder if it holds nothing else."""
    remove_temporary_files(directory)
    parts = directory / "parts"
    for file in (*(parts / name for name in names), directory / RECIPE_NAME, directory / MANIFEST_NAME):
        file.unlink(missing_ok=True)
    for folder in (parts, directory):
        with suppress(OSError):  # a file of the user is in it
            folder.rmdir()


def publish(path: Path | str, publication: Publication | Mapping[str, Any]) -> None:
    """Change licence, creators and references of a finished corpus.

    The parts stay as they are, and the other files of a folder are those of a corpus that was made with this publication from the start;
    a single file gets other attributes. A killed call leaves a corpus that can be read, and the same call completes it.

    Parameters
    ----------
    path : path
        The corpus.
    publication : mapping or Publication
        Keys of :class:`gen.corpus.Publication`, such as ``{"license": "CC-BY-4.0", "creators": [{"name": "Jane Doe"}]}``.

    Raises
    ------
    CorpusError
        If a key is unknown or a value is wrong; if the corpus is unfinished, altered or a part of another, another call changes it, or a
        file or its data card cannot be written.
    """
    path = Path(path)
    if not isinstance(publication, Publication):
        publication = read_publication(publication)
    check_card(path)
    corpus_files(path)
    manifest = read_manifest(path)
    publication = publication.dated()
    facts = manifest.model_dump(mode="json", exclude_unset=True) | {"publication": publication}
    if path.is_file():
        remove_left_behind_of(path)
        if publication == manifest.publication:
            return
        content = facts_of_parts([], facts) | {"records": manifest.records, "signals": manifest.signals._asdict()}
        content |= {"parts_sha256": manifest.parts_sha256} if manifest.parts_sha256 else {}
        old = {*facts, *publication_attributes(manifest)} - {"raceway_format"}
        rewrite_attributes(path, old, corpus_attributes(content, recipe_text(path), path))
        return
    with lock(path):
        remove_temporary_files(path)
        finish_corpus(path, manifest.parts, **facts)
