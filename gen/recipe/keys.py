"""Every key of a recipe with its unit, range, default and meaning, read from the model.

``raceway recipes --keys`` prints them, ``recipes/README.md`` lists them. A meaning is the docstring below the key in the model.
"""

import re
from collections.abc import Iterable, Iterator
from types import NoneType
from typing import Annotated, Any, NamedTuple, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from gen.drawing import DISTRIBUTIONS, Section, interval
from gen.recipe.changes import Changes
from gen.recipe.model import Recipe
from gen.support.errors import RecipeError
from gen.support.sentences import kinds_of, models_in
from gen.support.units import UNITS, unit_suffix


class Key(NamedTuple):
    """A key of a recipe, by its path without the numbers of list entries."""

    key: str
    """``NAME`` stands for a name that the recipe chooses."""
    kinds: tuple[str, ...]
    """Values of ``kind`` with which the key exists; empty if the section has no kinds."""
    unit: str
    """Symbol; empty if the value has none."""
    allowed: str
    """Range, choices or type of the value."""
    default: str
    meaning: str


def recipe_keys(prefix: str = "") -> list[Key]:
    """Keys whose path begins with ``prefix``, in the order of the model; ``distribution`` has the keys of distributions.

    Raises
    ------
    RecipeError
        If there is none.

    >>> [key.key for key in recipe_keys("corpus.split")]
    ['corpus.split', 'corpus.split.by', 'corpus.split.validation', 'corpus.split.test']
    """
    wanted = re.sub(r"\[\d*\]", "", prefix)
    kinds: dict[Key, list[str]] = {}  # keys that differ in their kinds alone are one
    for path, model, name in [*fields_below((Recipe,), (), set()), *fields_below(DISTRIBUTIONS, ("distribution",))]:
        kinds.setdefault(_key(".".join([*path, name]).replace("[]", ""), name, model), []).extend(kinds_of(model))
    every_key = [key._replace(kinds=tuple(dict.fromkeys(several))) for key, several in kinds.items()]
    keys = [key for key in every_key if key.key.startswith(wanted)]
    if not keys:
        tops = ", ".join([*Recipe.model_fields, "distribution"])
        raise RecipeError(f"{prefix}: no key of a recipe begins like this; the first words of keys are {tops}.")
    return keys


def _key(path: str, name: str, model: type[BaseModel]) -> Key:
    field, suffix = model.model_fields[name], name if name in UNITS else unit_suffix(name)
    unit, meaning = UNITS[suffix].symbol if suffix else "", " ".join((field.description or "").split())
    return Key(path, (), unit, _allowed(field), _default(field), meaning)


def fields_below(
    models: Iterable[type[BaseModel]], path: tuple[str, ...] = (), seen: set[type[BaseModel]] | None = None
) -> Iterator[tuple[tuple[str, ...], type[BaseModel], str]]:
    """Path, section and name of each key of the sections that a place can hold, and of all sections in them.

    A step into a list of sections ends in ``[]``, and one into sections by name is followed by ``NAME``. With ``seen``, each section comes
    once below a key of the recipe.
    """
    for model in models:
        for name in sorted(model.model_fields, key=lambda name: name != "kind"):
            yield path, model, name
            field, below = model.model_fields[name], seen if path or seen is None else set[type[BaseModel]]()
            inner = [
                section
                for section in _sections_of(field)
                if not any(issubclass(other, section) for other in below or ())
            ]
            if below is not None:
                below.update(inner)
            steps = {tuple: (f"{name}[]",), dict: (name, "NAME")}.get(get_origin(field.annotation) or type, (name,))
            yield from fields_below(inner, (*path, *steps), below)


def _sections_of(field: FieldInfo) -> list[type[Section]]:
    """Sections that the value of a field can be, or can be made of; not those with keys that are listed elsewhere."""
    models = dict.fromkeys(models_in(field.annotation))
    return [model for model in models if issubclass(model, Section) and not issubclass(model, Changes)]


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    default = field.default
    if default is None:
        return "none"
    if isinstance(default, tuple | Section):
        return "its defaults"
    if isinstance(default, dict):
        return ", ".join(default) or "none"
    return f"{default:g}" if isinstance(default, float) else str(default)


def _allowed(field: FieldInfo) -> str:
    """Range, choices or type of a field; a range alone is that of a distribution."""
    if isinstance(field.json_schema_extra, dict):
        return interval(field.json_schema_extra)
    sections = _sections_of(field)
    if not sections and not any(issubclass(model, Changes) for model in models_in(field.annotation)):
        return _plain(field.annotation, field.metadata)
    kinds = ", ".join(kind for section in sections for kind in kinds_of(section))
    form = {tuple: "list of sections", dict: "sections by name"}.get(get_origin(field.annotation) or type, "section")
    return f"{form}: {kinds}" if kinds else form


def _plain(annotation: Any, metadata: Iterable[Any]) -> str:
    """Type and limits of a value that is neither a section nor a distribution."""
    arguments = get_args(annotation)
    if NoneType in arguments:
        return _plain(arguments[0], metadata)
    if get_origin(annotation) is Annotated:
        inner, *more = arguments
        return _plain(inner, [*metadata, *(entry for part in more for entry in getattr(part, "metadata", [part]))])
    # limits stand in the annotations of pydantic
    limits = {name: getattr(entry, name) for entry in metadata for name in _LIMITS if hasattr(entry, name)}
    if get_origin(annotation) is tuple:
        return f"list of {_plain(arguments[0], [])}" + _sizes(limits, "entries")
    if get_origin(annotation) is dict:
        return f"{_plain(arguments[0], [])}, or weights of these"
    choices = [argument for argument in arguments if isinstance(argument, str)]
    if choices:
        return ", ".join(choices)
    name = {str: "text", int: "whole number", float: "number", bool: "true or false"}[annotation]
    return name + _sizes(limits, "characters") + _bounds(limits)


_LIMITS = ("ge", "gt", "le", "lt", "min_length", "max_length")


def _sizes(limits: dict[str, Any], of: str) -> str:
    """Sizes that a list or a text can have."""
    least, most = (limits.get(name) for name in ("min_length", "max_length"))
    if least is None:
        return ""
    return f" ({least} to {most} {of})" if most is not None else f" (at least {least} {of})"


def _bounds(limits: dict[str, Any]) -> str:
    """Bounds of a number: an interval, or one comparison."""
    limits = {name: _short(number) for name, number in limits.items() if number is not None}
    low = [sign + limits[name] for name, sign in (("ge", "["), ("gt", "(")) if name in limits]
    high = [limits[name] + sign for name, sign in (("le", "]"), ("lt", ")")) if name in limits]
    if low and high:
        return f" in {low[0]}, {high[0]}"
    return f" {'>=' if low[0][0] == '[' else '>'} {low[0][1:]}" if low else ""


def _short(number: float) -> str:
    """Number in as few digits as state it exactly."""
    return f"{number:g}" if float(f"{number:g}") == number else str(number)
