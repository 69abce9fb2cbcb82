"""How to cite a corpus: a sentence, and an entry for BibTeX."""

import re
from collections.abc import Sequence

from gen.corpus.manifest import Manifest
from gen.corpus.publication import Creator, Publication
from raceway.sharing.card.markdown import plain_text


def _note(manifest: Manifest) -> str:
    tool = f"Raceway {plain_text(manifest.versions.get('raceway', ''))}".strip()
    verb = "converted" if manifest.importer else "made"
    return f"Bearing vibration corpus of {manifest.records} records, {verb} with {tool}"


def citation(title: str, manifest: Manifest) -> str:
    """Citation as a sentence."""
    publication, title = manifest.publication, plain_text(title)
    names = [plain_text(person.name) for person in publication.creators]
    year = f" ({publication.date[:4]})" if publication.date else ""
    parts = [
        f"{_enumeration(names)}{year}: {title}" if names else f"{title}{year}",
        _note(manifest),
        plain_text(publication.institution or ""),
        f"https://doi.org/{plain_text(publication.doi)}" if publication.doi else "",
    ]
    return ". ".join(part for part in parts if part) + "."


def _enumeration(words: Sequence[str]) -> str:
    """Words joined for a sentence.

    >>> _enumeration(["a"]), _enumeration(["a", "b", "c"])
    ('a', 'a, b and c')
    """
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def bibtex(title: str, manifest: Manifest) -> str:
    """Entry of type ``misc``, which every BibTeX style knows."""
    publication, title = manifest.publication, plain_text(title)
    fields = {
        "title": f"{{{_escape(title)}}}",
        "author": " and ".join(_author(person) for person in publication.creators),
        "year": (publication.date or "")[:4],
        "publisher": _escape(plain_text(publication.institution or "")),
        "doi": plain_text(publication.doi or "").replace("{", "").replace("}", ""),
        "note": _escape(_note(manifest)),
    }
    entries = [f"  {name} = {{{value}}}," for name, value in fields.items() if value]
    return "\n".join([f"@misc{{{_key(title, publication)},", *entries, "}"])


def _author(creator: Creator) -> str:
    """Name in the list of authors. BibTeX parts that of a person, one with an ORCID, into first and last name.

    >>> _author(Creator(name="Jane Doe", orcid="0000-0002-1825-0097")), _author(Creator(name="Example Laboratory"))
    ('Jane Doe', '{Example Laboratory}')
    """
    name = _escape(plain_text(creator.name))
    return name if creator.orcid and " and " not in f" {name.lower()} " else f"{{{name}}}"


def _key(title: str, publication: Publication) -> str:
    """Key of an entry: last name of the first creator, year and first word of the title, in ASCII letters and digits.

    >>> _key("Quickstart corpus", Publication(creators=(Creator(name="Jane Doe"),), date="2026-03-31"))
    'doe2026quickstart'
    """
    names = publication.creators[0].name.split() if publication.creators else []
    words = [*names[-1:], (publication.date or "")[:4], *re.findall(r"[A-Za-z0-9]+", title)[:1]]
    return "".join(re.sub(r"[^a-z0-9]", "", word.lower()) for word in words) or "corpus"


def _escape(text: str) -> str:
    r"""Text for a field of BibTeX.

    >>> print(_escape("50 % of A & B_1"))
    50 \% of A \& B\_1
    """
    return "".join(_ESCAPES.get(letter, letter) for letter in text)


_ESCAPES = {letter: f"\\{letter}" for letter in "&%$#_{}"} | {"~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
