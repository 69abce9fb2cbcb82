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
    is_single_file,
    lock,
    manifest_of_parts,
    part_number,
    read_manifest,
    recipe_text,
    remove_temporary_files,
    write_durably,
    write_manifest,
    writing,
)
from gen.generation.identity import other_code, part_file
from gen.recipe import Recipe, read_recipe
from gen.support.errors import CorpusError, RecipeError
from gen.support.yaml_files import parse_yaml


@contextmanager
def claim(folder: Path) -> Iterator[None]:
    """Create the folder and lock it against other calls."""
    if folder.exists() and not folder.is_dir():
        raise CorpusError(f"{folder}: is a file; give a folder, or a file that ends in .nc, for the corpus.")
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with lock(folder):
        yield


def prepare(folder: Path, text: bytes, facts: dict[str, Any], recipe: Recipe) -> dict[str, Any]:
    """Check what the folder holds, and write the manifest of an unfinished corpus, unless it holds a finished one, which may grow.

    Returns ``facts``, with the publication that a corpus was given after it was made. The manifest is written first: it tells a corpus
    without any part from a folder that holds something else.
    """
    before = None
    with writing(folder):
        remove_temporary_files(folder)
        if (folder / MANIFEST_NAME).exists():
            before = read_manifest(folder)
            check_same(folder, before, facts, recipe)
            facts = facts | {"publication": before.publication}
        # nothing of a user is overwritten
        elif any(folder.iterdir()):
            raise CorpusError(f"{folder}: is not empty and holds no corpus; choose another folder.")
        if before is None or not before.complete:
            # from now on the folder says of what corpus its parts are
            write_manifest(folder, manifest_of_parts([], facts, complete=False).content)
            write_durably(text, folder / RECIPE_NAME)
            remove_other_parts(folder, recipe)
        (folder / "parts").mkdir(exist_ok=True)
    return facts


def records_of(place: Path, manifest: Manifest) -> int | None:
    """Number of records that a corpus has or is to have, by its recipe; None if a call was killed before it stored the recipe."""
    recipe = place / RECIPE_NAME
    if place.is_file():
        recipe = parse_yaml(recipe_text(place) or "", place, RecipeError)
    elif not recipe.exists():
        return None
    return read_recipe(recipe, **manifest.overrides or {}).n_records


def check_same(place: Path, manifest: Manifest, facts: dict[str, Any], recipe: Recipe) -> None:
    """Refuse a corpus that cannot become that of the recipe: another one, one of other sources or libraries, or one with other records."""
    if manifest.recipe_sha256 is None:
        raise CorpusError(
            f"{place}: holds a corpus that was not generated from a recipe as a whole; choose another name."
        )
    if manifest.recipe_sha256 != facts["recipe_sha256"]:
        raise CorpusError(
            f"{place}: holds a corpus of another recipe or seed; choose another name, or grow a folder with its old recipe "
            "and --records N."
        )
    before, asked = records_of(place, manifest), recipe.n_records
    if before is not None and (asked < before or (place.is_file() and asked > before)):
        raise CorpusError(
            f"{place}: holds a corpus of {before} records and not {asked}; a folder grows, and no corpus shrinks: choose another name."
        )
    # other libraries can round otherwise
    began = {"versions": manifest.versions, "sources_sha256": manifest.sources_sha256}
    if other := other_code(began, facts):
        raise CorpusError(
            f"{place}: was begun with {other[0]}; {other[1]} is installed and can give other samples: install the former to "
            "complete it, or choose another name."
        )


def part_numbers(folder: Path) -> set[int]:
    """Numbers of the parts that have a file, whole or not, full or not."""
    numbers = (part_number(path.name) for path in (folder / "parts").glob("part-*.nc"))
    return {number for number in numbers if number is not None}


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
