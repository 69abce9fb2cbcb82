"""The whole data card: a page in Markdown on the records of a corpus, their faults, labels and terms of use."""

import functools
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from gen.corpus.disk import CARD_NAME, CARD_SUFFIX, corpus_around, place_of, write_text_durably
from gen.corpus.fault_classes import FAULTS
from gen.corpus.index import open_corpus
from gen.corpus.lazy import stored_classes
from gen.corpus.manifest import RECIPE_NAME, Manifest, corpus_files, read_manifest, recipe_text
from gen.corpus.schema import listed_flags
from gen.corpus.trust import codec_of
from gen.support.errors import CorpusError
from raceway.sharing.card import additions
from raceway.sharing.card.card_facts import card_facts
from raceway.sharing.card.citation import citation
from raceway.sharing.card.markdown import code_text, plain_text
from raceway.sharing.publication import publication_of

if TYPE_CHECKING:
    from jinja2 import Template

MOST_SENTENCES = 100  # of a list; the manifest has all


def card_folder(path: Path) -> Path:
    """Folder of the data card of a corpus: its own, or for a single file ``NAME.nc`` the folder ``NAME.card`` beside it."""
    return path.with_suffix(CARD_SUFFIX) if path.is_file() else path


def check_card(path: Path) -> None:
    """Refuse a file of records that lies in a corpus, or has something else than its data card in the folder for it."""
    folder = card_folder(path)
    if folder == path:
        return
    if (corpus := corpus_around(place_of(path).parent)) is not None:
        raise CorpusError(f"{path}: is a file of the corpus {corpus}; give that corpus.")
    is_card = (folder / additions.ADDITIONS_NAME).exists() and corpus_around(folder) is None
    if not is_card and any(folder.glob("[!.]*")):  # hidden files are those of a killed call
        raise CorpusError(f"{folder}: holds no data card of raceway; move it, or give the corpus another name.")


def data_card(path: Path | str) -> str:
    """Data card of a finished corpus, made from its files: the same files give the same page.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing or of another size than in the manifest.
    """
    path = Path(path)
    manifest = read_manifest(path)
    added = additions.read_additions(card_folder(path), manifest)
    first = corpus_files(path, "size")[0]
    with open_corpus(path, check="size") as corpus:
        return card_text(corpus, manifest, added, path, first)


def card_text(corpus: xr.Dataset, manifest: Manifest, added: additions.CardAdditions, path: Path, first: Path) -> str:
    """Page of an opened corpus that lies at ``path``, whose ``first`` file has signals."""
    title = str(corpus.attrs.get("title", "Untitled corpus"))
    publication, single = publication_of(manifest), path.is_file()
    # what a person has stated, with a row for each
    terms = (
        ("licence", publication.license),
        *(("creator", ", https://orcid.org/".join(filter(None, (it.name, it.orcid)))) for it in publication.creators),
        ("institution", publication.institution),
        ("contact", publication.contact),
        ("DOI", f"https://doi.org/{publication.doi}" if publication.doi else None),
        *(("reference", reference) for reference in publication.references),
        ("date", publication.date),
    )
    return _template().render(
        **card_facts(corpus, manifest),
        title=title,
        publication=publication,
        terms=[row for row in terms if row[1]],
        added=added,
        whole=path.name if single else None,
        file=path.name if single else first.relative_to(path).as_posix(),
        parts=len(manifest.parts),
        zstd=codec_of(first) == "zstd",
        faulty=listed_flags({code: name for code, name in stored_classes(first).items() if name in FAULTS[1:]}),
        citation=citation(title, manifest),
        most=MOST_SENTENCES,
    )


@functools.cache
def _template() -> "Template":
    """Template of the page, in which every text is without Markdown."""
    from jinja2 import Environment, PackageLoader, StrictUndefined  # takes 50 ms

    environment = Environment(
        loader=PackageLoader("raceway.sharing.card", ""),
        autoescape=False,  # noqa: S701 - Markdown, of which plain_text leaves nothing
        # what a filter of the template has made harmless is marked as safe there
        finalize=lambda value: (
            plain_text(value) if isinstance(value, str) and not hasattr(value, "__html__") else value
        ),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters |= {
        "cells": lambda cells: " | ".join(plain_text(cell) for cell in cells),
        "code": code_text,
        "shell": lambda words: " ".join(shlex.quote(code_text(word)) for word in words),
        "file_name": lambda name: "".join(letter for letter in name if letter.isalnum() or letter in "-_."),
    }
    return environment.get_template("card.md.jinja")


def write_card(path: Path | str) -> None:
    """Write the data card of a finished corpus, ``README.md``, whole or not at all, and beside that of a single file its recipe."""
    path = Path(path)
    if path.is_file() and (recipe := recipe_text(path)) is not None:
        write_text_durably(recipe, card_folder(path) / RECIPE_NAME)
    write_text_durably(data_card(path), card_folder(path) / CARD_NAME)
