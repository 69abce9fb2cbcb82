"""How a corpus was made, how to make it again, and what is left out, for its data card."""

import shlex
from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from gen.corpus.card.markdown import code_text, plain_text
from gen.corpus.manifest import Choice, Manifest, Origin

RECIPE_NAME = "recipe.yaml"
MOST_SENTENCES = 100  # of a list; the manifest has all
_NEW = "../again"

_SIMULATED = (
    "Simulated by Raceway from {source}: Hertz contact between balls and raceways, shaft, housing and sensor resonance, classical "
    "Runge-Kutta. `raceway replay` makes any record again, bit for bit."
)


def origin(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Paragraph on the origin of the records."""
    lines = [_made(corpus, manifest)]
    if manifest.origins:
        lines += ["", *(f"{number}. {_part(origin)}" for number, origin in enumerate(manifest.origins, start=1))]
    if manifest.selections:
        lines += ["", *(_selected(choice) for choice in manifest.selections)]
    return lines


def _made(corpus: xr.Dataset, manifest: Manifest) -> str:
    if manifest.origins:
        return f"Merged from {len(manifest.origins)} corpora, in the order of the records:"
    if manifest.importer is not None:
        return f"Origin: {plain_text(corpus.attrs.get('source', 'unknown'))}"
    if manifest.recipe is not None and _given_by_hand(manifest):
        return _SIMULATED.format(source=f"scenarios that were made by hand (variable `draws`) and `{RECIPE_NAME}`")
    if manifest.recipe is not None:
        return _SIMULATED.format(source=f"`{RECIPE_NAME}` (recipe {plain_text(manifest.recipe)})")
    facts = [plain_text(corpus.attrs[name]) for name in ("source", "history") if corpus.attrs.get(name)]
    return f"Origin: {'; '.join(facts) or 'unknown'}"


def _part(origin: Origin) -> str:
    """One of the corpora that were merged."""
    title = plain_text(origin.title or "corpus without a title")
    if origin.importer is not None:
        made = f"recordings, by `raceway import {plain_text(origin.importer)}`"
    elif origin.recipe_file is not None:
        made = f"simulated from `{origin.recipe_file}`"
    else:
        made = "of unknown origin"
    chosen = "; ".join(_selected(choice) for choice in origin.selections)
    return (
        f"{title}: {made}, {origin.parts} {'part' if origin.parts == 1 else 'parts'}{f'. {chosen}' if chosen else '.'}"
    )


def _selected(choice: Choice) -> str:
    asked = code_text(choice)
    return f"Selected from a corpus of {choice.records} records{f' (`{asked}`)' if asked else ''}."


def _given_by_hand(made: Manifest | Origin) -> bool:
    """Whether the scenarios were not drawn from the recipe."""
    return getattr(made, "scenarios", None) is not None


def rebuilding(manifest: Manifest) -> list[str]:
    """Section with the commands that make the corpus again."""
    lines = ["", "## How to make it again", ""]
    commands = _merging(manifest.origins) if manifest.origins else _steps(manifest, RECIPE_NAME, _NEW)
    if not commands:
        if _given_by_hand(manifest):
            return [
                *lines,
                "Single records only: `raceway replay . --record I` makes record I from its stored scenario.",
            ]
        return [*lines, "The folder does not say how it was made; keep a copy."]
    if any(command[1] == "import" for command in commands):
        lines += ["With the folder of the recordings in place of FOLDER:", ""]
    elif manifest.origins or manifest.recipe is not None:
        lines += ["In this folder:", ""]
    lines += ["```sh", *(" ".join(map(_quoted, words)) for words in commands), "```"]
    if versions := _versions(manifest):
        lines += ["", f"Made with {versions}. The same versions give the same bytes of every part."]
    return lines


def _versions(manifest: Manifest) -> str:
    """Versions of the libraries, of each of the corpora that were merged."""
    each = [made.versions for made in manifest.origins or (manifest,)]
    texts = [", ".join(f"{plain_text(name)} {plain_text(number)}" for name, number in found.items()) for found in each]
    return "; ".join(dict.fromkeys(filter(None, texts)))


def _quoted(word: str) -> str:
    """Word of a command line; one with single quotes, as in most conditions, stands in double quotes.

    >>> print(_quoted("fault == 'inner'"), _quoted("corpus"), _quoted("a b"))
    "fault == 'inner'" corpus 'a b'
    """
    text = code_text(word)
    return f'"{text}"' if "'" in text and not set(text) & set('"$\\!') else shlex.quote(text)


def _merging(origins: Sequence[Origin]) -> list[list[str]]:
    """Commands that make each corpus and merge them; none if one of them cannot be made again."""
    folders = [f"{_NEW}-{number}" for number in range(1, len(origins) + 1)]
    each = [_steps(origin, origin.recipe_file or "", folder) for origin, folder in zip(origins, folders, strict=True)]
    if not all(each):
        return []
    last = [words[words.index("-o") + 1] for words in (steps[-1] for steps in each)]
    return [words for steps in each for words in steps] + [["raceway", "merge", *last, "-o", _NEW]]


def _steps(made: Manifest | Origin, recipe_file: str, folder: str) -> list[list[str]]:
    """Commands that make one corpus that was not merged; none if that is not known."""
    if made.importer is not None:
        commands = [["raceway", "import", made.importer, "FOLDER", "-o", folder]]
    elif made.recipe is not None and not _given_by_hand(made):
        commands = _simulating(made, recipe_file, folder)
    else:
        return []
    for number, choice in enumerate(made.selections, start=1):
        if choice.where is choice.split is choice.channels is None:  # only the folder tells which records were kept
            return []
        chosen = f"{folder}-selected-{number}" if number > 1 else f"{folder}-selected"
        commands.append(["raceway", "select", folder, *_options(choice), "-o", chosen])
        folder = chosen
    return commands


def _simulating(made: Manifest | Origin, recipe_file: str, folder: str) -> list[list[str]]:
    overrides = made.overrides.model_dump() if made.overrides is not None else {}
    words = ["raceway", "generate", recipe_file, "-o", folder]
    for name in ("seed", "records"):
        words += [f"--{name}", str(overrides[name])] if overrides.get(name) is not None else []
    extensions = [next(iter(extension.items())) for extension in overrides.get("extensions") or ()]
    return [words, *(["raceway", "extend", folder, f"--{what}", str(count)] for what, count in extensions)]


def _options(choice: Choice) -> list[str]:
    channels = ",".join(choice.channels) if choice.channels else None
    given = {"--where": choice.where, "--split": choice.split, "--channels": channels}
    return [word for name, value in given.items() if value is not None for word in (name, value)]


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


def recipe_files(directory: Path) -> list[Path]:
    """Recipes of a corpus: ``recipe.yaml``, or those of the corpora that were merged, in ``recipes/``."""
    one = directory / RECIPE_NAME
    return [one] if one.is_file() else sorted((directory / "recipes").glob("*.yaml"))
