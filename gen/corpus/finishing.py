"""The files of a finished corpus beside its parts: index and manifest; one file of all parts."""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from gen.corpus.disk import CARD_NAME, CROISSANT_NAME, remove_left_behind
from gen.corpus.index import corpus_attributes, join_parts, write_index
from gen.corpus.manifest import (
    INDEX_NAME,
    MANIFEST_NAME,
    RECIPE_NAME,
    facts_of_parts,
    recipe_text,
    write_manifest,
)
from gen.corpus.part import PartRow
from gen.corpus.unusable import SignalCounts


def finish_corpus(directory: Path, rows: Iterable[PartRow], **facts: Any) -> SignalCounts:
    """Write index and manifest over finished parts; returns the counts of records that cannot be used.

    ``facts`` are further fields of the manifest. A data card with its ``croissant.json`` describes the corpus as it was and is removed;
    ``raceway.describe`` writes both.
    """
    rows = list(rows)
    content = facts_of_parts(rows, facts)
    write_index(directory, rows, corpus_attributes(content, recipe_text(directory), directory))
    write_manifest(directory, content)
    if (directory / CROISSANT_NAME).exists():  # a README.md alone can be one of the user
        for name in (CARD_NAME, CROISSANT_NAME):
            (directory / name).unlink(missing_ok=True)
    return SignalCounts(**content["signals"])


def finish_file(directory: Path, rows: Iterable[PartRow], file: Path, **facts: Any) -> SignalCounts:
    """Write all parts of a folder into one file; returns the counts of records that cannot be used."""
    rows = list(rows)
    content = facts_of_parts(rows, facts)
    join_parts(directory, rows, corpus_attributes(content, recipe_text(directory), directory), file)
    return SignalCounts(**content["signals"])


def remove_temporary_files(directory: Path) -> None:
    """Remove temporary files that killed calls have left beside the files of a corpus; no other process may be writing into it."""
    for name in (MANIFEST_NAME, INDEX_NAME, CARD_NAME, "card.json", RECIPE_NAME, CROISSANT_NAME):
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
