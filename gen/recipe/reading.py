"""Read and check a recipe; the model compares counts and sizes with the limits."""

import functools
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from gen.corpus import RECIPE_TEXT
from gen.drawing import plain
from gen.recipe.finding import find_recipe
from gen.recipe.model import Recipe
from gen.support.errors import RecipeError
from gen.support.yaml_files import parse_yaml, read_yaml

if TYPE_CHECKING:
    import xarray as xr


def read_recipe(
    recipe: "Path | str | Mapping[str, Any] | Recipe | xr.Dataset",
    *,
    seed: int | None = None,
    records: int | None = None,
) -> Recipe:
    """Read and check a recipe.

    Parameters
    ----------
    recipe : path, str, mapping, Recipe or Dataset
        File, name of a recipe that ships with Raceway, the keys of a recipe with their values, a recipe that has been read, or a Dataset of
        :func:`gen.record`, :func:`gen.records` or :func:`gen.open_corpus`, which holds the recipe that its records were made from.
    seed, records : int, optional
        Replace those of the recipe.

    Raises
    ------
    RecipeError
        If the file is missing, is not YAML, or has wrong keys or values, one sentence for each of them; if the Dataset holds no recipe.
    """
    overrides = {key: value for key, value in (("seed", seed), ("records", records)) if value is not None}
    if isinstance(recipe, Recipe):
        return Recipe(plain(recipe), **overrides) if overrides else recipe
    if isinstance(recipe, str | Path):
        where: Path | str = find_recipe(recipe)
        data = read_yaml(where, RecipeError)
    # a Dataset of records has its recipe in an attribute
    elif (attributes := getattr(recipe, "attrs", None)) is not None:
        where = f"{RECIPE_TEXT} of the Dataset"
        if RECIPE_TEXT not in attributes:
            raise RecipeError(f"{where}: there is none; give a Dataset of records of one recipe, with its attributes.")
        data = parse_yaml(str(attributes[RECIPE_TEXT]), where, RecipeError)
    elif isinstance(recipe, Mapping):
        return Recipe(cast("Mapping[str, Any]", recipe), **overrides)  # a Dataset is a mapping too
    else:
        raise RecipeError(
            f"recipe: {type(recipe).__name__} given; give a path, the name of a recipe or a mapping of its keys."
        )
    try:
        return Recipe(data, **overrides)
    except RecipeError as error:
        # each sentence names the file
        raise RecipeError("\n".join(f"{where}: {sentence}" for sentence in str(error).split("\n"))) from None


def recipe_hash(recipe: Recipe) -> str:
    """SHA-256 of the values of a recipe that records depend on; ``records``, layout and comments do not count."""
    return _hash(recipe, {"records"})


@functools.lru_cache(maxsize=16)
def corpus_identity(recipe: Recipe) -> str:
    """First 12 digits of the SHA-256 of the values that draws depend on: with the same ones, equal numbers are the same machine."""
    if recipe.origin is not None:
        return recipe.origin.corpus
    return _hash(recipe, {"storage", "records", "name", "title"})[:12]


def _hash(recipe: Recipe, left_out: set[str]) -> str:
    """SHA-256 of the values of a recipe; a mechanism that it does not have does not count."""
    values = recipe.model_dump(mode="json", exclude=left_out, exclude_none=True)
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()
