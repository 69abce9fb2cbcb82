"""How a corpus was made, how to make it again, and what is left out, for its data card."""

import shlex
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import xarray as xr

from gen.corpus.card.markdown import code_text, plain_text
from gen.corpus.manifest_fields import Choice, Manifest, Origin, extensions_of

RECIPE_NAME = "recipe.yaml"
MOST_SENTENCES = 100  # of a list; the manifest has all
_NEW = "../again"

_SIMULATED = (
    "Simulated by Raceway from `recipe.yaml` (recipe {recipe}): Hertz contact between balls and raceways, shaft, housing and sensor "
    "resonance, classical Runge-Kutta. `raceway replay` makes any record again, bit for bit."
)
_SCENARIOS = {
    "chosen": " The records are some of those of the recipe.",
    "given": " The scenarios were not drawn from the recipe; each is stored with its record, in `draws`.",
}
_WRITTEN = (
    "`gen.write_corpus` made it from records in Python; `raceway replay` makes each of them again from this folder."
)


def origin(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Paragraph on the origin of the records."""
    lines = [_made(corpus, manifest)]
    if manifest.origins:
        lines += ["", *_merged(manifest)]
    for choice in manifest.selections:
        lines += ["", f"{_selected(choice)}. Rigs, specimens and recordings keep their numbers."]
    return lines


def _made(corpus: xr.Dataset, manifest: Manifest) -> str:
    if manifest.origins:
        return f"Merged from {len(manifest.origins)} corpora by `raceway merge`; their machines have different numbers:"
    if manifest.importer is not None:
        return f"Origin: {plain_text(corpus.attrs.get('source', 'unknown'))}"
    if manifest.recipe is not None:
        return _SIMULATED.format(recipe=plain_text(manifest.recipe)) + _SCENARIOS.get(manifest.scenarios or "", "")
    facts = [plain_text(corpus.attrs[name]) for name in ("source", "history") if corpus.attrs.get(name)]
    return f"Origin: {'; '.join(facts) or 'unknown'}"


def _merged(manifest: Manifest) -> list[str]:
    """Entry of a list for each of the corpora that were merged, with the numbers of its records."""
    rows, first, lines = iter(manifest.parts), 0, list[str]()
    for number, origin in enumerate(manifest.origins, start=1):
        stop = first + sum(row.records for row in islice(rows, origin.parts))
        how = "of unknown origin"
        if origin.importer is not None:
            how = f"imported by {plain_text(origin.importer)}"
        elif origin.recipe is not None:
            how = f"simulated from recipe {plain_text(origin.recipe)} in `{origin.recipe_file}`"
        facts = "; ".join([how, *map(_selected, origin.selections)])
        lines.append(
            f"{number}. The records of {plain_text(origin.title or 'a corpus')} are {first} to {stop - 1} ({facts})."
        )
        first = stop
    return lines


def _selected(choice: Choice) -> str:
    asked = code_text(choice)
    return f"Selected from {choice.records:,} records" + (f" by `raceway select` (`{asked}`)" if asked else "")


def rebuilding(manifest: Manifest, window: float) -> list[str]:
    """Section with the commands that make the corpus again; ``window`` is the length of a record [s]."""
    lines = ["", "## How to make it again", ""]
    commands = _commands(manifest, window)
    if not commands:
        if manifest.scenarios is not None:
            return [*lines, _WRITTEN]
        return [*lines, "The folder does not say how it was made; keep a copy."]
    if any(command[1] == "import" for command in commands):
        lines += [
            "With your copy of the recordings in place of SRC, and with the other options of the import, which the folder does not tell:",
            "",
        ]
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


def _commands(manifest: Manifest, window: float) -> list[list[str]]:
    """Commands that make the corpus; none if one of its steps is not known."""
    if not manifest.origins:
        return _chosen(_made_from(manifest, RECIPE_NAME, _NEW, window), manifest.selections)
    commands: list[list[str]] = []
    folders: list[str] = []
    for number, origin in enumerate(manifest.origins, start=1):
        made = _made_from(origin, origin.recipe_file or "", f"{_NEW}-{number}", window)
        steps = _chosen(made, origin.selections)
        if not steps:
            return []
        commands += steps
        folders.append(steps[-1][-1])
    return _chosen([*commands, ["raceway", "merge", *folders, "-o", _NEW]], manifest.selections)


def _made_from(made: Manifest | Origin, recipe_file: str, folder: str, window: float) -> list[list[str]]:
    """Commands that make a corpus from recordings or a recipe, before any choice; the last word of each is the folder."""
    if made.importer is not None:
        return [["raceway", "import", made.importer, "SRC", "--window", f"{window:g}", "-o", folder]]
    if made.recipe is not None and made.scenarios is None:
        return _simulating(made, recipe_file, folder)
    return []


def _chosen(commands: list[list[str]], choices: Sequence[Choice]) -> list[list[str]]:
    """The commands, and those that choose records of the folder that the last of them names at its end."""
    for choice in choices:
        if (
            not commands or choice.where is choice.split is choice.channels is None
        ):  # only the folder tells which records were kept
            return []
        source = commands[-1][-1]
        commands = [*commands, ["raceway", "select", source, *_options(choice), "-o", f"{source}-selected"]]
    return commands


def _simulating(made: Manifest | Origin, recipe_file: str, folder: str) -> list[list[str]]:
    overrides = made.overrides.model_dump() if made.overrides is not None else {}
    words = ["raceway", "generate", recipe_file]
    for name in ("seed", "records"):
        words += [f"--{name}", str(overrides[name])] if overrides.get(name) is not None else []
    extensions = [next(iter(extension.items())) for extension in extensions_of(made)]
    words += ["-o", folder]
    return [words, *(["raceway", "extend", f"--{what}", str(count), folder] for what, count in extensions)]


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
