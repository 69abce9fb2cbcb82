"""Pages written from the code: ``python -m gen.pages ROOT`` renews them.

``recipes/schema.json`` and ``recipes/README.md`` follow from the model of the recipe, ``docs/format.md`` from the schema of the corpus,
``docs/catalogue.md`` from the catalogue of bearings, ``docs/limits.md`` from the limits.
"""

import sys
from pathlib import Path
from types import NoneType
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from gen.corpus import format_page
from gen.limits import limits_page
from gen.physics.catalogue import catalogue_page
from gen.recipe import model
from gen.recipe.distributions import Choice, Constant, Grid, LogUniform, Normal, Uniform
from gen.recipe.reading import recipe_purpose, recipe_schema, shipped_recipes

_HEAD = """# Recipes

A recipe is a YAML file; `raceway plan RECIPE` says what it would make, `raceway generate RECIPE -o DIR` makes it.
Keys end in their unit. Wherever a range is given, the value may be a number or a distribution:

"""


def readme() -> str:
    """Markdown page: the shipped recipes, the distributions, and every key with its range and default."""
    lines = [_HEAD, "| distribution | keys | what it gives |", "|---|---|---|"]
    for distribution in (Constant, Uniform, LogUniform, Normal, Choice, Grid):
        keys = ", ".join(name for name in distribution.model_fields if name != "kind")
        lines.append(
            f"| `{get_args(distribution.model_fields['kind'].annotation)[0]}` | {keys} | {_first_line(distribution)} |"
        )
    lines += ["", "## Shipped", "", "| name | what for |", "|---|---|"]
    lines += [f"| `{name}` | {recipe_purpose(path)} |" for name, path in shipped_recipes().items()]
    for section in _sections(model.Recipe, []):
        lines += [
            "",
            f"## {section.__name__}",
            "",
            _first_line(section),
            "",
            "| key | allowed | default |",
            "|---|---|---|",
        ]
        lines += [_row(name, field) for name, field in section.model_fields.items()]
    return "\n".join(lines) + "\n"


def _row(name: str, field: FieldInfo) -> str:
    default = "required" if field.is_required() else _shown(field.default)
    return f"| `{name}` | {field.description or _type(field.annotation, field)} | {default} |"


def _shown(default: Any) -> str:
    if isinstance(default, BaseModel):
        return "see below"
    if isinstance(default, tuple):
        return "one, as below"
    return "none" if default is None else f"`{default}`"


def _type(annotation: Any, field: FieldInfo) -> str:
    metadata: list[Any] = field.metadata
    sections = [found.__name__ for found in _models(annotation)]
    if sections:
        return " or ".join(dict.fromkeys(sections))
    if NoneType in get_args(annotation):
        annotation = get_args(annotation)[0]
    if get_origin(annotation) is Annotated:
        annotation, *metadata = get_args(annotation)
        metadata = [entry for part in metadata for entry in getattr(part, "metadata", [part])]
    names = [arg for arg in get_args(annotation) if isinstance(arg, str)]
    if names:
        return ", ".join(f"`{name}`" for name in names)
    limits = ", ".join(_limit(entry) for entry in metadata if _limit(entry))
    plain = (
        getattr(annotation, "__name__", "")
        .replace("str", "text")
        .replace("int", "whole number")
        .replace("float", "number")
    )
    return f"{plain if plain.isascii() and plain[:1].islower() else 'mapping'}{' ' + limits if limits else ''}"


def _limit(entry: Any) -> str:
    signs = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
    return " ".join(f"{sign} {getattr(entry, key):g}" for key, sign in signs.items() if hasattr(entry, key))


def _models(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for arg in get_args(annotation) for found in _models(arg)]


def _sections(section: type[BaseModel], found: list[type[BaseModel]]) -> list[type[BaseModel]]:
    """Sections of a recipe in the order in which they are met, each once, distributions left out."""
    if section not in found and issubclass(section, model.Section):
        found.append(section)
        for field in section.model_fields.values():
            for inner in _models(field.annotation):
                _sections(inner, found)
    return found


def _first_line(thing: type) -> str:
    return (thing.__doc__ or "").strip().splitlines()[0]


PAGES = {
    "recipes/schema.json": recipe_schema,
    "recipes/README.md": readme,
    "docs/format.md": format_page,
    "docs/catalogue.md": catalogue_page,
    "docs/limits.md": limits_page,
}

if __name__ == "__main__":
    for name, page in PAGES.items():
        (Path(sys.argv[1]) / name).write_text(page(), encoding="utf-8")
