"""Read and check a recipe file; the model compares counts and sizes with the limits."""

import functools
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gen.recipe.finding import find_recipe
from gen.recipe.model import Recipe
from gen.recipe.section import plain
from gen.support.errors import RecipeError
from gen.support.yaml_files import read_yaml


def read_recipe(
    recipe: Path | str | Mapping[str, Any] | Recipe, *, seed: int | None = None, records: int | None = None
) -> Recipe:
    """Read and check a recipe.

    Parameters
    ----------
    recipe : path, str, mapping or Recipe
        File, name of a recipe that ships with Raceway, the keys of a recipe with their values, or a recipe that has been read.
    seed, records : int, optional
        Replace those of the recipe.

    Raises
    ------
    RecipeError
        If the file is missing, is not YAML, or has wrong keys or values; one sentence for each of them.
    """
    overrides = {key: value for key, value in (("seed", seed), ("records", records)) if value is not None}
    if isinstance(recipe, Recipe):
        return Recipe(plain(recipe), **overrides) if overrides else recipe
    if isinstance(recipe, Mapping):
        return Recipe(recipe, **overrides)
    if not isinstance(recipe, str | Path):
        raise RecipeError(
            f"recipe: {type(recipe).__name__} given; give a path, the name of a recipe or a mapping of its keys."
        )
    path = find_recipe(recipe)
    data = read_yaml(path, RecipeError)
    try:
        return Recipe(data, **overrides)
    except RecipeError as error:
        raise RecipeError("\n".join(f"{path}: {sentence}" for sentence in str(error).split("\n"))) from None


def recipe_hash(recipe: Recipe) -> str:
    """SHA-256 of the values of a recipe that records depend on; ``publication``, layout and comments do not count."""
    values = recipe.model_dump(mode="json", exclude={"publication"})
    if recipe.corpus.fault_choice == "by_weight":  # the key is younger than the first corpora, whose hashes stay
        del values["corpus"]["fault_choice"]
    text = json.dumps(values, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


@functools.lru_cache(maxsize=16)
def corpus_identity(recipe: Recipe) -> str:
    """First 12 digits of the SHA-256 of the values that draws depend on: with the same ones, equal numbers are the same machine."""
    storage = {
        "storage": True,
        "publication": True,
        "records": True,
        "name": True,
        "title": True,
    }
    text = json.dumps(recipe.model_dump(mode="json", exclude=storage), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def recipe_schema() -> str:
    """JSON schema of a recipe, for editors."""
    schema = Recipe.model_json_schema()
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}, indent=1) + "\n"
