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
    every_key = _merge([*_keys_of((Recipe,), "", set()), *_keys_of(DISTRIBUTIONS, "distribution.", set())])
    keys = [key for key in every_key if key.key.startswith(wanted)]
    if not keys:
        tops = ", ".join([*Recipe.model_fields, "distribution"])
        raise RecipeError(f"{prefix}: no key of a recipe begins like this; the first words of keys are {tops}.")
    return keys


def _key(name: str, field: FieldInfo, path: str, kinds: tuple[str, ...]) -> Key:
    suffix = name if name in UNITS else unit_suffix(name)
    unit = UNITS[suffix].symbol if suffix else ""
    return Key(path + name, kinds, unit, _allowed(field), _default(field), _one_line(field.description))


def _one_line(text: str | None) -> str:
    return " ".join((text or "").split())


def _keys_of(models: Iterable[type[BaseModel]], path: str, seen: set[type[BaseModel]]) -> Iterator[Key]:
    """Keys of the sections that one place can hold, and of the sections in them; each section once below a key of the recipe."""
    for model in models:
        kinds = _kinds(model)
        for name in sorted(model.model_fields, key=lambda name: name != "kind"):
            field = model.model_fields[name]
            yield _key(name, field, path, kinds)
            below = set() if model is Recipe else seen
            inner = [section for section in _sections_of(field) if not any(issubclass(one, section) for one in below)]
            below.update(inner)
            place = f"{path}{name}." + ("NAME." if get_origin(field.annotation) is dict else "")
            yield from _keys_of(inner, place, below)


def _kinds(model: type[BaseModel]) -> tuple[str, ...]:
    return get_args(model.model_fields["kind"].annotation) if "kind" in model.model_fields else ()


def _sections_of(field: FieldInfo) -> list[type[Section]]:
    """Sections that the value of a field can be, or can be made of; not those with keys that are listed elsewhere."""
    models = [model for model in dict.fromkeys(_models(field.annotation)) if issubclass(model, Section)]
    return [model for model in models if not issubclass(model, Changes)]


def _merge(keys: list[Key]) -> list[Key]:
    """Keys with those joined that differ in their kinds alone."""
    kinds_of: dict[Key, list[str]] = {}
    for key in keys:
        kinds_of.setdefault(key._replace(kinds=()), []).extend(key.kinds)
    return [key._replace(kinds=tuple(dict.fromkeys(kinds))) for key, kinds in kinds_of.items()]


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
    if not sections and any(issubclass(model, Changes) for model in _models(field.annotation)):
        return "section"
    if not sections:
        return _plain(field.annotation, field.metadata)
    kinds = ", ".join(kind for section in sections for kind in _kinds(section))
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
    limits = {name: getattr(entry, name) for entry in metadata for name in _LIMITS if hasattr(entry, name)}
    if get_origin(annotation) is tuple:
        return f"list of {_plain(arguments[0], [])}" + _range(limits, " ({} entries)", "min_length", "max_length")
    if get_origin(annotation) is dict:
        return f"{_plain(arguments[0], [])}, or weights of these"
    choices = [argument for argument in arguments if isinstance(argument, str)]
    if choices:
        return ", ".join(choices)
    name = {str: "text", int: "whole number", float: "number", bool: "true or false"}[annotation]
    return name + _range(limits, " ({} characters)", "min_length", "max_length") + _bounds(limits)


_LIMITS = ("ge", "gt", "le", "lt", "min_length", "max_length")


def _range(limits: dict[str, Any], form: str, low: str, high: str) -> str:
    """Sizes that a list or a text can have."""
    if limits.get(low) is None:
        return ""
    least, most = limits[low], limits.get(high)
    return form.format(f"{least} to {most}" if most is not None else f"at least {least}")


def _bounds(limits: dict[str, Any]) -> str:
    """Bounds of a number: an interval, or one comparison."""
    low = next(
        ((sign, limits[name]) for name, sign in (("ge", "["), ("gt", "(")) if limits.get(name) is not None), None
    )
    high = next(
        ((sign, limits[name]) for name, sign in (("le", "]"), ("lt", ")")) if limits.get(name) is not None), None
    )
    if low and high:
        return f" in {low[0]}{_short(low[1])}, {_short(high[1])}{high[0]}"
    return f" >= {_short(low[1])}" if low else ""


def _short(number: float) -> str:
    """Number in as few digits as state it exactly."""
    return f"{number:g}" if float(f"{number:g}") == number else str(number)


def _models(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for argument in get_args(annotation) for model in _models(argument)]
