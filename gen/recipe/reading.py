"""Read and check a recipe file; the model compares counts and sizes with the limits."""

import hashlib
import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from gen.errors import RecipeError
from gen.recipe.finding import find_recipe
from gen.recipe.model import Recipe
from gen.recipe.sentences import sentences
from gen.yaml_files import read_yaml


def read_recipe(recipe: Path | str, *, seed: int | None = None, records: int | None = None) -> Recipe:
    """Read and check a recipe.

    Parameters
    ----------
    recipe : path or str
        File, or name of a recipe that ships with Raceway.
    seed, records : int, optional
        Replace those of the recipe.

    Raises
    ------
    RecipeError
        If the file is missing, is not YAML, or has wrong keys or values; one sentence for each of them.
    """
    path = find_recipe(recipe)
    data = _load(path)
    overrides = {"seed": seed, "records": records}
    data |= {key: value for key, value in overrides.items() if value is not None}
    try:
        return Recipe.model_validate(data)
    except ValidationError as error:
        raise RecipeError("\n".join(f"{path}: {sentence}" for sentence in sentences(error))) from None


def recipe_hash(recipe: Recipe) -> str:
    """SHA-256 of the values of a recipe that records depend on; ``publication``, layout and comments do not count."""
    text = json.dumps(recipe.model_dump(mode="json", exclude={"publication"}), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def recipe_schema() -> str:
    """JSON schema of a recipe, for editors."""
    schema = Recipe.model_json_schema()
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}, indent=1) + "\n"


def _load(path: Path) -> dict[str, Any]:
    data = read_yaml(path, RecipeError)
    if not isinstance(data, dict) or not all(isinstance(key, str) for key in data):
        raise RecipeError(
            f"{path}: a recipe is a mapping that starts with name:, title: and corpus:; see raceway recipes."
        )
    return data
