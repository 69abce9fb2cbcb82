"""A recipe as YAML text."""

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gen.corpus import write_text_durably
from gen.recipe.model import Recipe
from gen.recipe.section import plain
from gen.support.errors import RecipeError

_LONGEST = 100  # characters of a list or mapping on one line
_WORDS = ("null", "true", "false", "yes", "no", "on", "off", "y", "n")  # the last six are booleans in YAML 1.1
_WORD = re.compile(r"[a-z][a-z0-9_]*")
_EXPRESSION = re.compile(r"[a-z]+\([\w.,()= +-]*\)( \* \w+)?|[\d.e+-]+ \* \w+")  # needs no quotes outside of braces


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
    return "".join(_lines(plain(recipe), ""))


def _lines(section: Mapping[str, Any], indent: str) -> list[str]:
    lines = []
    for key, value in section.items():
        whole = _flow(value)
        if isinstance(value, dict) and value and len(indent + key + whole) > _LONGEST:
            lines += [f"{indent}{_name(key)}:\n", *_lines(value, indent + "  ")]
        elif isinstance(value, list) and len(value) > 1 and isinstance(value[0], dict):
            lines += [f"{indent}{_name(key)}:\n", *(f"{indent}  - {_flow(item)}\n" for item in value)]
        else:
            bare = isinstance(value, str) and _EXPRESSION.fullmatch(value)
            lines.append(f"{indent}{_name(key)}: {value if bare else whole}\n")
    return lines


def _flow(value: Any) -> str:
    """Value on one line, as YAML 1.2; text has double quotes unless it is a word that cannot be mistaken."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_name(key)}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return _name(value) if isinstance(value, str) else json.dumps(value)


def _name(text: str) -> str:
    if _WORD.fullmatch(text) and text not in _WORDS:
        return text
    shown = json.dumps(text, ensure_ascii=False)
    return "".join(letter if letter.isprintable() else f"\\U{ord(letter):08x}" for letter in shown)
