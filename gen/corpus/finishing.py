"""The files of a finished corpus beside its parts: index, manifest and data card; and a change of its publication."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from gen.corpus.acdd import publication_attributes
from gen.corpus.card.page import write_card
from gen.corpus.croissant import CROISSANT_NAME, write_croissant
from gen.corpus.files import remove_left_behind
from gen.corpus.index import new_index, write_index
from gen.corpus.locking import locked
from gen.corpus.manifest import (
    EXTENSION_NAME,
    INDEX_NAME,
    MANIFEST_NAME,
    Manifest,
    listed_file,
    manifest_content,
    part_paths,
    read_manifest,
    with_publication,
    write_content,
    write_manifest,
)
from gen.corpus.part import PartRow
from gen.corpus.publication import Publication
from gen.corpus.signals import SignalCounts, summed
from gen.errors import CorpusError


def finish_corpus(
    directory: Path, rows: Iterable[PartRow], *, publication: Publication | None = None, **facts: Any
) -> SignalCounts:
    """Write index, manifest and data card over finished parts; returns the counts of records that cannot be used.

    ``facts`` are further fields of the manifest.
    """
    rows = list(rows)
    signals = summed(row.signals for row in rows)
    facts["publication"] = publication or Publication()
    write_index(directory, rows, publication_attributes(_manifest(manifest_content(rows, **facts))))
    write_manifest(directory, rows, complete=True, **facts)
    write_card(directory)
    write_croissant(directory)
    return signals


def remove_temporary_files(directory: Path) -> None:
    """Remove temporary files that killed calls have left beside the files of a corpus; no other process may be writing into it."""
    for name in (MANIFEST_NAME, EXTENSION_NAME, INDEX_NAME, "README.md", "recipe.yaml", CROISSANT_NAME):
        remove_left_behind(directory, name)
    remove_left_behind(directory / "parts", "part-*.nc")


def publish(directory: Path | str, publication: Publication) -> None:
    """Change licence, creators and references of a finished corpus: in its manifest, ``corpus.nc`` and data card.

    The parts stay as they are. The files are those of a corpus that was made with this publication from the start. A killed call leaves
    a corpus that can be read, with the old or the new facts, and the same call completes it.

    Raises
    ------
    CorpusError
        If the corpus is unfinished or altered, another call changes it, or a file cannot be written.
    """
    directory = Path(directory)
    publication = publication.dated()
    if directory.is_file():
        raise CorpusError(
            f"{directory}: is one file; unpack it with raceway unpack, publish the folder, and pack that."
        )
    with locked(directory):
        part_paths(directory, "sha256")
        rows = read_manifest(directory).parts
        content: dict[str, Any] = json.loads((directory / "manifest.json").read_bytes())
        content["index"] = listed_file(directory / INDEX_NAME)
        changed = with_publication(content, publication)
        with new_index(directory, rows, publication_attributes(_manifest(changed))) as temporary:
            changed["index"] = listed_file(temporary)
            write_content(directory, content | {"next_index": changed["index"]})  # until the new index is in place
        write_content(directory, changed)
        write_card(directory)
        write_croissant(directory)


def _manifest(content: dict[str, Any]) -> Manifest:
    return Manifest.model_validate_json(json.dumps(content))
