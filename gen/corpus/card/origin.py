"""How a corpus was made, how to make it again, and what is left out, for its data card."""

import shlex
from collections.abc import Iterable, Sequence
from pathlib import Path

import xarray as xr

from gen.corpus.card.markdown import plain_text
from gen.corpus.manifest import Choice, Manifest

RECIPE_NAME = "recipe.yaml"
MOST_SENTENCES = 100  # of a list; the manifest has all

_SIMULATED = (
    "Simulated by Raceway from `recipe.yaml` (recipe {recipe}): Hertz contact between balls and raceways, shaft, housing and sensor "
    "resonance, classical Runge-Kutta. `raceway replay` makes any record again, bit for bit."
)
_SCENARIOS = {
    None: "",
    "chosen": " The records are some of those of the recipe.",
    "given": " The scenarios were not drawn from the recipe; each is stored with its record, in `draws`.",
}


def origin(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    """Paragraph on the origin of the records, and on the choices by which they were taken from a larger corpus."""
    return [*_maker(corpus, manifest), *(line for choice in manifest.selections for line in ("", _chosen(choice)))]


def _chosen(choice: Choice) -> str:
    return f"Selected from {choice.records:,} records by `raceway select` ({plain_text(choice)}); all numbers are those of that corpus."


def _maker(corpus: xr.Dataset, manifest: Manifest) -> list[str]:
    if manifest.origins:
        whole = "Joined by `raceway merge`; machines of different corpora have different numbers. The records of"
        return [f"{whole} {_of_origins(manifest)}."]
    if manifest.importer is not None:
        return [f"Origin: {plain_text(corpus.attrs.get('source', 'unknown'))}"]
    if manifest.recipe is not None:
        return [_SIMULATED.format(recipe=plain_text(manifest.recipe)) + _SCENARIOS[manifest.scenarios]]
    facts = [plain_text(corpus.attrs[name]) for name in ("source", "history") if corpus.attrs.get(name)]
    return [f"Origin: {'; '.join(facts) or 'unknown'}"]


def _of_origins(manifest: Manifest) -> str:
    """Corpora that were merged, with the range of their records."""
    rows, first, found = iter(manifest.parts), 0, []
    for origin in manifest.origins:
        stop = first + sum(next(rows).records for _ in range(origin.parts))
        how = "not stated how it was made"
        if origin.importer is not None:
            how = f"imported by {plain_text(origin.importer)}"
        elif origin.recipe is not None:
            how = f"simulated from recipe {plain_text(origin.recipe)} in `{origin.recipe_file}`"
        chosen = "".join(f", selected ({plain_text(choice)})" for choice in origin.selections)
        found.append(f"{plain_text(origin.title or 'a corpus')} are {first} to {stop - 1} ({how}{chosen})")
        first = stop
    return "; ".join(found)


def rebuilding(manifest: Manifest) -> list[str]:
    """Section with the commands that make the corpus again."""
    lines = ["", "## How to make it again", ""]
    if manifest.origins:
        folders = [f"FOLDER-{number}" for number in range(1, len(manifest.origins) + 1)]
        commands = [["raceway", "merge", *folders, "-o", "../corpus-again"]]
        lines += ["Make the corpora that it was joined from, then join them:"]
    elif manifest.importer is not None:
        commands = [["raceway", "import", manifest.importer, "FOLDER", "-o", "corpus"]]
        lines += ["From the recordings, which are not in this folder:"]
    elif manifest.scenarios is not None:
        return [
            *lines,
            "`gen.write_corpus` made it from records in Python; `raceway replay` makes each of them again from this folder.",
        ]
    elif manifest.recipe is not None:
        commands = [_generate(manifest)]
        lines += ["In this folder:"]
    else:
        return [*lines, "The folder does not say how it was made; keep a copy."]
    for number, choice in enumerate(manifest.selections, start=1):
        source = commands[-1][-1]
        commands.append(["raceway", "select", source, *_options(choice), "-o", f"../selection-{number}"])
    lines += _shell(commands)
    if manifest.versions:
        versions = ", ".join(f"{plain_text(name)} {plain_text(number)}" for name, number in manifest.versions.items())
        lines += ["", f"Made with {versions}. The same versions give the same bytes of every part."]
    return lines


def _options(choice: Choice) -> list[str]:
    """Options of ``raceway select`` for a choice."""
    given = {
        "--where": choice.where,
        "--split": choice.split,
        "--channels": choice.channels and ",".join(choice.channels),
    }
    return [word for option, value in given.items() if value is not None for word in (option, value)]


def _generate(manifest: Manifest) -> list[str]:
    """Command with the seed and the number of records that replaced those of the recipe."""
    words = ["raceway", "generate", RECIPE_NAME, "-o", "../corpus-again"]
    overrides = manifest.overrides
    if overrides is not None:
        for name, value in (("--seed", overrides.seed), ("--records", overrides.records)):
            words += [name, str(value)] if value is not None else []
    return words


def _shell(commands: Iterable[Sequence[str]]) -> list[str]:
    return ["", "```sh", *(shlex.join(plain_text(word) for word in words) for words in commands), "```"]


def left_out(manifest: Manifest) -> list[str]:
    """Sections on what labels rest on, on changes of signals, and on files and records that are left out."""
    sections = (
        ("What labels and units rest on", manifest.basis),
        ("Assumptions and changes", manifest.warnings),
        ("Skipped files", manifest.skipped),
        ("Records left out", manifest.failures),
    )
    lines: list[str] = []
    for heading, sentences in sections:
        # of a simulated corpus, only the records that could not be simulated matter
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
