"""Terms of use of a finished corpus, and the pages that describe it: the data card ``README.md``, and ``croissant.json``."""

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py

from gen.corpus.disk import (
    append_checksum,
    remove_checksum,
    remove_left_behind_of,
    remove_temporary_files,
    whole_or_not_at_all,
    writing,
)
from gen.corpus.locking import lock
from gen.corpus.manifest import (
    INDEX_NAME,
    Manifest,
    finished,
    read_manifest,
    write_manifest,
)
from gen.corpus.part import write_texts
from gen.corpus.trust import LIBRARY_LOCK, attributes_of, library_errors, open_trusted
from raceway.sharing.acdd import attributes_or_none
from raceway.sharing.card.additions import read_additions, write_additions
from raceway.sharing.card.card_page import card_folder, check_card, write_card
from raceway.sharing.croissant import write_croissant
from raceway.sharing.publication import Publication, read_publication


def describe(path: Path | str) -> None:
    """Write the data card and ``croissant.json`` of a finished corpus; those of a single file go into the folder ``NAME.card``.

    Raises
    ------
    CorpusError
        If the corpus is unfinished or altered, or a file cannot be written.
    """
    path = Path(path)
    check_card(path)
    manifest, folder = read_manifest(path), card_folder(path)
    if path.is_file():  # card.json tells the folder of a card from one that holds something else
        with writing(folder):
            folder.mkdir(exist_ok=True)
        write_additions(folder, read_additions(folder, manifest))
    else:
        _write_attributes(path / INDEX_NAME, manifest)
    write_card(path)
    write_croissant(path)


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
    # a card that somebody else wrote is not replaced
    check_card(path)
    manifest = finished(path)
    published = manifest.model_copy(update={"publication": publication.dated().stored})
    if path.is_file():
        remove_left_behind_of(path)
        # a single file that was never published has no such attributes
        if published.publication or manifest.publication:
            _write_attributes(path, published)
        return
    with lock(path):
        remove_temporary_files(path)
        write_manifest(path, published.content)
        describe(path)


def _write_attributes(file: Path, manifest: Manifest) -> None:
    """Give a single file, or an index, the attributes of publication, in a copy that takes its place."""
    wanted = {"publication": json.dumps(manifest.publication) if manifest.publication else None}
    wanted |= attributes_or_none(manifest)
    with library_errors(file), open_trusted(file) as stored:
        before = attributes_of(stored)
    other = {name: value for name, value in wanted.items() if (value or None) != before.get(name)}
    if not other:
        return
    with whole_or_not_at_all(file) as temporary:
        shutil.copyfile(file, temporary)
        remove_checksum(temporary)
        with LIBRARY_LOCK, h5py.File(temporary, "r+") as changed:
            for name in other.keys() & before.keys():
                del changed.attrs[name]
        write_texts(temporary, {name: value for name, value in other.items() if value})
        append_checksum(temporary)
