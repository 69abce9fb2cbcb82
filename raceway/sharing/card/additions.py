"""Pictures and scores on a data card, listed in ``card.json``; ``raceway card`` writes them.

They describe the parts whose hashes they were made for. On the card of a corpus whose parts have changed they are left out.
"""

import json
from pathlib import Path

from pydantic import ValidationError

from gen.corpus.disk import plain_file, write_text_durably
from gen.corpus.manifest import Manifest, Strict, first_problem
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

ADDITIONS_NAME = "card.json"
PICTURES = "pictures"


class CardPicture(Strict):
    """A picture in the folder ``pictures``, with its heading and caption."""

    name: str
    title: str
    caption: str


class CardScore(Strict):
    """Balanced accuracy of one classifier with its 95 % interval, and those of both controls."""

    name: str
    score: float
    interval: tuple[float, float] | None
    random_records: float
    permuted_labels: float


class CardScores(Strict):
    """Scores of classifiers that were cross-validated by ``track``."""

    track: str
    folds: int
    seed: int
    features: tuple[str, ...]
    classes: tuple[str, ...]
    records: int
    raceway: str
    rows: tuple[CardScore, ...]


class CardAdditions(Strict):
    """Contents of ``card.json``."""

    parts: str
    """SHA-256 over the hashes of the parts that pictures and scores are about."""
    pictures: tuple[CardPicture, ...] = ()
    scores: CardScores | None = None


def read_additions(directory: Path, manifest: Manifest) -> CardAdditions:
    """Pictures and scores of the present parts; empty without ``card.json``, or if the parts have changed.

    Raises
    ------
    CorpusError
        If the file is not what ``raceway card`` writes.
    """
    nothing = CardAdditions(parts=manifest.parts_sha256 or "")
    if not (directory / ADDITIONS_NAME).exists():
        return nothing
    path = plain_file(directory, ADDITIONS_NAME)
    check_limit("manifest_bytes", path.stat().st_size, f"{path}:", CorpusError)
    try:
        additions = CardAdditions.model_validate_json(path.read_bytes())
    except ValidationError as error:
        raise CorpusError(f"{path}: {first_problem(error)}; delete it and run raceway card again.") from None
    return additions if additions.parts == nothing.parts else nothing


def write_additions(directory: Path, additions: CardAdditions) -> None:
    """Write ``card.json``, whole or not at all."""
    write_text_durably(json.dumps(additions.model_dump(mode="json"), indent=1) + "\n", directory / ADDITIONS_NAME)
