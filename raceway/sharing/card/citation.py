"""How to cite a corpus."""

from collections.abc import Sequence

from gen.corpus.manifest import Manifest
from raceway.sharing.card.markdown import plain_text
from raceway.sharing.publication import publication_of


def citation(title: str, manifest: Manifest) -> str:
    """Citation as a sentence."""
    publication, title = publication_of(manifest), plain_text(title)
    names = [plain_text(person.name) for person in publication.creators]
    year = f" ({publication.date[:4]})" if publication.date else ""
    tool = f"Raceway {plain_text(manifest.versions.get('raceway', ''))}".strip()
    parts = [
        f"{_enumeration(names)}{year}: {title}" if names else f"{title}{year}",
        f"Bearing vibration corpus of {manifest.records} records, {'converted' if manifest.importer else 'made'} with {tool}",
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
