"""Terms of use of a finished corpus, and the pages that describe it: the data card ``README.md``, and ``croissant.json``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gen.corpus import Publication
from gen.corpus.acdd import publication_attributes
from gen.corpus.disk import remove_left_behind_of, writing
from gen.corpus.finishing import finish_corpus, remove_temporary_files
from gen.corpus.index import corpus_attributes, rewrite_attributes
from gen.corpus.locking import lock
from gen.corpus.manifest import corpus_files, facts_of_parts, read_manifest, recipe_text
from gen.corpus.publication import read_publication
from raceway.sharing.card.additions import read_additions, write_additions
from raceway.sharing.card.card_page import card_folder, check_card, write_card
from raceway.sharing.croissant import write_croissant


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
    corpus_files(path)
    manifest = read_manifest(path)
    publication = publication.dated()
    facts = manifest.model_dump(mode="json", exclude_unset=True) | {"publication": publication}
    if path.is_file():
        remove_left_behind_of(path)
        if publication == manifest.publication:
            return
        # a single file keeps its counts, of which it has no parts to count
        content = facts_of_parts([], facts) | {"records": manifest.records, "signals": manifest.signals._asdict()}
        content |= {"parts_sha256": manifest.parts_sha256} if manifest.parts_sha256 else {}
        old = {*facts, *publication_attributes(manifest)} - {"raceway_format"}
        rewrite_attributes(path, old, corpus_attributes(content, recipe_text(path), path))
        return
    with lock(path):
        remove_temporary_files(path)
        finish_corpus(path, manifest.parts, **facts)
        describe(path)
