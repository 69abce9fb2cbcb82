"""Pictures and scores on a data card, listed in ``card.json``; ``raceway card`` writes them.

They describe the parts whose hashes they were made for. On the card of a corpus whose parts have changed they are left out.
"""

import json
from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError

from gen.corpus.card.markdown import plain_text, table
from gen.corpus.files import plain_file, write_text_durably
from gen.corpus.manifest import Manifest, Strict, first_problem
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

CARD_NAME = "card.json"
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
    if not (directory / CARD_NAME).exists():
        return nothing
    path = plain_file(directory, CARD_NAME)
    check_limit("manifest_bytes", path.stat().st_size, f"{path}:", CorpusError)
    try:
        additions = CardAdditions.model_validate_json(path.read_bytes())
    except ValidationError as error:
        raise CorpusError(f"{path}: {first_problem(error)}; delete it and run raceway card again.") from None
    return additions if additions.parts == nothing.parts else nothing


def write_additions(directory: Path, additions: CardAdditions) -> None:
    """Write ``card.json``, whole or not at all."""
    write_text_durably(json.dumps(additions.model_dump(mode="json"), indent=1) + "\n", directory / CARD_NAME)


_LINES = (
    "Under each waveform is its squared envelope spectrum over orders of the shaft, after whitening. The lines of the fault at their "
    "nominal orders are shaded, those of other faults and of the shaft are dashed."
)


def pictures(drawings: Sequence[CardPicture]) -> list[str]:
    """Section with the pictures."""
    lines = ["", "## Pictures", "", _LINES] if drawings else []
    for picture in drawings:
        title, caption = plain_text(picture.title), plain_text(picture.caption)
        lines += ["", f"**{title}**: {caption}", "", f"![{title}]({PICTURES}/{_safe(picture.name)})"]
    return lines


def _safe(name: str) -> str:
    """File name without characters that end a link; ours have none of them."""
    return "".join(letter for letter in name if letter.isalnum() or letter in "-_.")


def scores(card: CardScores | None) -> list[str]:
    """Section with the scores."""
    if card is None or not card.rows:
        return []
    meaning = (
        f"Balanced accuracy of classifiers on {card.records} records of {', '.join(map(plain_text, card.classes))}, cross-validated by "
        f"{plain_text(card.track)} in {card.folds} folds; chance is {1 / max(len(card.classes), 1):.3f}. A split of random records "
        f"leaks, so its score is too good; permuted labels must score at chance."
    )
    rows = (
        (
            plain_text(row.name),
            f"{row.score:.3f}",
            _interval(row),
            f"{row.random_records:.3f}",
            f"{row.permuted_labels:.3f}",
        )
        for row in card.rows
    )
    header = ("classifier", "score", "95 % interval", "random records", "permuted labels")
    command = (
        f"raceway benchmark . -o ../report --track {plain_text(card.track)} --folds {card.folds} --seed {card.seed}"
    )
    origin = f"Raceway {plain_text(card.raceway)}, features {', '.join(map(plain_text, card.features))}: `{command}`"
    return ["", "## Scores", "", meaning, *table(header, rows, right=4), "", origin]


def _interval(row: CardScore) -> str:
    return "unknown" if row.interval is None else f"{row.interval[0]:.3f} to {row.interval[1]:.3f}"
