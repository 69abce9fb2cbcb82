"""How a corpus was made, how to make it again, and what is left out, for its data card."""

import shlex
from collections.abc import Sequence

import xarray as xr

from gen.corpus.card.markdown import code_text, plain_text
from gen.corpus.manifest import RECIPE_NAME, Manifest

MOST_SENTENCES = 100  # of a list; the manifest has all
_NEW = "../again"

_SIMULATED = (
    "Simulated by Raceway from recipe {recipe}: Hertz contact between balls and raceways, shaft, housing and sensor resonance, classical "
    "Runge-Kutta. `raceway replay` makes any record again, bit for bit, from the scenario that is stored with it."
)
_JOINED = (
    "Simulated and recorded: the variable `identity` names for each record the corpus that it comes from. Simulated records "
    "(recipe {recipe}) store their scenario, from which `raceway replay` makes them again, bit for bit."
)


def origin(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Paragraph on the origin of the records."""
    if manifest.recipe is not None:
        text = _JOINED if manifest.importer else _SIMULATED
        return [text.format(recipe=plain_text(manifest.recipe))]
    facts = [plain_text(corpus.attrs[name]) for name in ("source", "history") if corpus.attrs.get(name)]
    return [f"Origin: {'; '.join(facts) or 'unknown'}"]


def rebuilding(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Section with the command that makes the corpus again."""
    lines = ["", "## How to make it again", ""]
    if manifest.recipe_sha256 is not None:
        lines += ["In this folder:", "", "```sh", _quote(_generating(manifest)), "```"]
    elif manifest.recordings is not None and manifest.importer is not None:
        window = corpus.sizes["elapsed_time"] / float(corpus["sample_rate"][0])
        words = ["raceway", "import", manifest.importer, "SRC", "--window", f"{window:g}", "-o", _NEW]
        lines += [
            "With your copy of the recordings in place of SRC, and the other options of the import, which are not stored in the corpus:",
            "",
            *("```sh", _quote(words), "```"),
        ]
    else:
        lines += [f"History of the corpus: {plain_text(corpus.attrs.get('history', 'not known'))}."]
    if manifest.versions:
        versions = ", ".join(f"{plain_text(name)} {plain_text(number)}" for name, number in manifest.versions.items())
        lines += ["", f"Made with {versions}. The same versions give the same bytes of every part."]
    return lines


def _generating(manifest: Manifest) -> list[str]:
    overrides = manifest.overrides.model_dump() if manifest.overrides is not None else {}
    words = ["raceway", "generate", RECIPE_NAME]
    for name in ("seed", "records"):
        words += [f"--{name}", str(overrides[name])] if overrides.get(name) is not None else []
    return [*words, "-o", _NEW]


def _quote(words: Sequence[str]) -> str:
    return " ".join(shlex.quote(code_text(word)) for word in words)


def left_out(manifest: Manifest) -> list[str]:
    """Sections on the basis of labels, on changes of signals, and on files and records that are left out."""
    sections = (
        ("What labels and units rest on", manifest.basis),
        ("Assumptions and changes", manifest.warnings),
        ("Skipped files", manifest.skipped),
        ("Records left out", manifest.failures),
    )
    lines: list[str] = []
    for heading, sentences in sections:
        if sentences or (manifest.importer is not None and heading in ("Assumptions and changes", "Skipped files")):
            lines += ["", f"## {heading}", "", *_bullets(sentences)]
    return lines


def _bullets(sentences: Sequence[str]) -> list[str]:
    shown = [f"- {plain_text(sentence)}" for sentence in sentences[:MOST_SENTENCES] or ("Nothing.",)]
    more = len(sentences) - MOST_SENTENCES
    return [*shown, f"- {more} more in `manifest.json`."] if more > 0 else shown
