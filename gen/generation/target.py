"""The folder of a corpus that is generated: claimed for one call, and checked against what is to be made.

What it holds is refused, completed, or grows; a finished corpus stays what it is meanwhile.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from gen.corpus import (
    MANIFEST_NAME,
    RECIPE_NAME,
    Manifest,
    facts_of_parts,
    file_facts,
    is_single_file,
    lock,
    read_manifest,
    remove_temporary_files,
    row_of,
    write_durably,
    write_manifest,
    writing,
)
from gen.generation.facts import part_file
from gen.recipe import Recipe, read_recipe
from gen.support.errors import CorpusError, RecipeError


@contextmanager
def claim(folder: Path) -> Iterator[None]:
    """Create the folder and lock it against other calls."""
    if folder.exists() and not folder.is_dir():
        raise CorpusError(f"{folder}: is a file; give a folder, or a file that ends in .nc, for the corpus.")
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with lock(folder):
        yield


def prepare(folder: Path, text: bytes, facts: dict[str, Any], recipe: Recipe) -> None:
    """Check what the folder holds, and write the manifest of an unfinished corpus, unless it holds a finished one, which may grow.

    The manifest is written first: it tells a corpus without any part from a folder that holds something else.
    """
    finished = False
    with writing(folder):
        remove_temporary_files(folder)
        if (folder / MANIFEST_NAME).exists():
            manifest = read_manifest(folder)
            check_same(folder, manifest, facts)
            _check_generated(folder, manifest)
            _check_growth(folder, manifest, recipe)
            if not facts["publication"].stored:
                facts["publication"] = manifest.publication  # given after the corpus was made
            finished = manifest.complete
        elif any(folder.iterdir()):
            raise CorpusError(f"{folder}: is not empty and holds no corpus; choose another folder.")
        if not finished:
            write_manifest(folder, facts_of_parts([], facts, complete=False))
            write_durably(text, folder / RECIPE_NAME)
        (folder / "parts").mkdir(exist_ok=True)
        if not finished:
            remove_other_parts(folder, recipe)


def _check_growth(folder: Path, manifest: Manifest, recipe: Recipe) -> None:
    """Refuse a corpus with fewer records than the one in the folder."""
    overrides = {} if manifest.overrides is None else dict(manifest.overrides)
    begun = folder / RECIPE_NAME  # not there if a call was killed before its first part
    before = read_recipe(begun, **overrides).n_records if begun.exists() else recipe.n_records
    if recipe.n_records < before:
        raise CorpusError(
            f"{folder}: holds a corpus of {before} records and not {recipe.n_records}; a corpus grows and does not shrink: choose another "
            "name."
        )


def check_same(place: Path, manifest: Manifest, facts: dict[str, Any]) -> None:
    """Refuse to complete a corpus of another recipe, or one that other sources or libraries began: its records would not go together."""
    if manifest.recipe_sha256 is None:
        raise CorpusError(
            f"{place}: holds a corpus that was not generated from a recipe as a whole; choose another name."
        )
    if manifest.recipe_sha256 != facts["recipe_sha256"]:
        raise CorpusError(f"{place}: holds a corpus of another recipe or seed; choose another name.")
    began = manifest.versions | {"sources": (manifest.sources_sha256 or "unknown")[:12]}
    now = facts["versions"] | {"sources": facts["sources_sha256"][:12]}
    other = [name for name in now if began.get(name) != now[name]]
    if other:
        was, installed = (
            ", ".join(f"{name} {versions.get(name, 'none')}" for name in other) for versions in (began, now)
        )
        raise CorpusError(
            f"{place}: was begun with {was}; {installed} is installed and can give other samples: install the former to "
            "complete it, or choose another name."
        )


def _check_generated(folder: Path, manifest: Manifest) -> None:
    """Refuse a copy: its parts have other records than those that are generated, and would be made again."""
    whole = next(filter(row_of, (folder / "parts" / row.name for row in manifest.parts)), None)
    if whole is not None and "recipe_sha256" not in file_facts(whole)[0]:
        raise CorpusError(f"{folder}: holds a copy of a corpus, which is not generated again; choose another name.")


def remove_other_parts(folder: Path, recipe: Recipe) -> None:
    """Remove a last part that was not full, of a corpus with fewer records."""
    for path in (folder / "parts").glob("part-*-*.nc"):
        if path.name != part_file(recipe, recipe.n_parts - 1):
            path.unlink(missing_ok=True)


def check_parts(recipe: Recipe, parts: range, target: Path) -> None:
    """Refuse parts that a corpus does not have, or some parts of a single file."""
    last = recipe.n_parts - 1
    if is_single_file(target):
        raise CorpusError(f"{target}: is one file, which has all parts; give a folder for some of them.")
    if not parts or parts.step != 1 or parts.start < 0 or parts[-1] > last:
        asked = f"{parts.start}-{parts.stop - 1}"
        raise RecipeError(f"parts: {asked} is not allowed; {recipe.name} has the parts 0-{last}, give a range of them.")
