"""A recipe as YAML text."""

import io
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.representer import SafeRepresenter

from gen.corpus import write_text_durably
from gen.drawing import plain
from gen.recipe.model import Recipe
from gen.support.errors import RecipeError

_LONGEST_LINE = 90


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
    yaml.Representer = _Representer
    yaml.default_flow_style, yaml.width = None, 1000
    yaml.representer.sort_base_mapping_type_on_output = False
    text = io.StringIO()
    keys = {key: value for key, value in plain(recipe).items() if value != {}}
    yaml.dump(_without_points(keys), text)
    return text.getvalue()


class _Representer(SafeRepresenter):
    """Short sections without others on one line."""

    def represent_mapping(self, tag: str, mapping: Any, flow_style: bool | None = None) -> Any:
        node = super().represent_mapping(tag, mapping, flow_style)
        if sum(len(key.value) + len(str(value.value)) + 4 for key, value in node.value) > _LONGEST_LINE:
            node.flow_style = False
        return node


def _without_points(value: Any) -> Any:
    """Value with whole numbers in place of floats such as 3.0."""
    if isinstance(value, dict):
        return {key: _without_points(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_points(item) for item in value]
    return int(value) if isinstance(value, float) and value.is_integer() and abs(value) < 1e15 else value
