"""A recipe as YAML text."""

import io
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from gen.corpus import write_text_durably
from gen.drawing import plain
from gen.recipe.model import Recipe
from gen.support.errors import RecipeError


def write_recipe(recipe: Recipe, path: Path | str) -> None:
    """Write a recipe to a YAML file that :func:`gen.read_recipe` reads as the same recipe; an existing file is replaced.

    Raises
    ------
    RecipeError
        If it is no recipe.
    CorpusError
        If the file cannot be written.
    """
    if not isinstance(recipe, Recipe):
        raise RecipeError(
            f"recipe: {type(recipe).__name__} given; give one that gen.make_recipe or gen.read_recipe gave."
        )
    write_text_durably(recipe_text(recipe), Path(path))


def recipe_text(recipe: Recipe) -> str:
    """YAML text of a recipe: the keys that were given, one section below the other."""
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style, yaml.width = None, 100  # sections without others on one line
    yaml.representer.sort_base_mapping_type_on_output = False
    text = io.StringIO()
    yaml.dump(_without_points(plain(recipe)), text)
    return text.getvalue()


def _without_points(value: Any) -> Any:
    """Value with whole numbers in place of floats such as 3.0."""
    if isinstance(value, dict):
        return {key: _without_points(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_points(item) for item in value]
    return int(value) if isinstance(value, float) and value.is_integer() and abs(value) < 1e15 else value
