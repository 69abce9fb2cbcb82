"""Error sentences for broken recipes and labels: the place, the value found, and what is allowed or what to do."""

import difflib
import functools
import re
import reprlib
from typing import Any, get_args

from pydantic import AliasChoices, BaseModel, ValidationError
from pydantic.fields import FieldInfo

_MOST_SENTENCES = 20
_LONGEST_KEY = 60  # characters shown


def sentences(error: ValidationError, model: type[BaseModel]) -> list[str]:
    """One sentence for each wrong key or value of a ``model``; a key that is missing because it is misspelt counts once."""
    items = error.errors()
    meant = {(*item["loc"][:-1], _guess(item["loc"], model)) for item in items if item["type"] == "extra_forbidden"}
    # the rest of a distribution in braces without quotes, {width_mm: uniform(1, 2)}; its beginning has an error too
    rest = {item["loc"] for item in items if item["type"] == "extra_forbidden" and str(item["loc"][-1]).endswith(")")}
    meant |= rest if len(rest) < len(items) else set()
    unique: dict[str, None] = {}
    for place, item in enumerate(items):
        sentence = None if item["loc"] in meant else _sentence(item, model)
        if sentence and len(unique) == _MOST_SENTENCES:
            return [*unique, f"there are up to {len(items) - place} more errors; correct these first."]
        if sentence:
            unique[sentence] = None
    return list(unique)


def _sentence(item: Any, model: type[BaseModel]) -> str | None:
    """Sentence about one error; None if another error says more about it."""
    place, value, kind, context = _place(item["loc"], model), item["input"], item["type"], item.get("ctx", {})
    shown = "nothing" if value is None else reprlib.repr(value) if isinstance(value, str | int | float) else "this"
    match kind:
        case "extra_forbidden":
            guess, allowed = _guess(item["loc"], model), ", ".join(_siblings(item["loc"], model))
            return f"{place}: no such key; " + (
                f"did you mean {guess}?" if guess else f"allowed are {allowed}{_others(place)}."
            )
        case "invalid_key":
            section = _place(item["loc"][:-1], model)
            return f"{section}: {reprlib.repr(value)} is not a key; keys are words, and decimals have a point, not a comma."
        case "missing":
            return f"{place}: is missing; give it."
        case "union_tag_invalid":
            expected = context["expected_tags"].replace("'", "")
            return f"{place}.kind: {reprlib.repr(context['tag'])} is not one of {expected}{_others(place)}."
        case "union_tag_not_found":
            kinds = [kind for section in _last(item["loc"], model).models for kind in kinds_of(section)]
            return f"{place}: {shown} needs a kind: {', '.join(kinds)}."
        case "value_error":
            text = item["msg"].removeprefix("Value error, ")
            if place.endswith("width_mm") and "is not in" in text:
                text = text.removesuffix(".") + "; for a bearing without a fault use kind: healthy."
            if not place:
                return text
            return f"{place}{'.' if text.partition(':')[0] in _siblings((*item['loc'], ''), model) else ': '}{text}"
        case "too_short":
            least = context["min_length"]
            size = len(item["input"])
            if size >= least:  # the wrong entries are not counted, and have sentences of their own
                return None
            what = f"{size} is too few" if size else "is empty"
            return f"{place}: {what}; give at least {'one' if least == 1 else least}."
        case "string_too_short":
            return f"{place}: is empty; give a text."
        case "string_too_long":
            return f"{place}: {len(str(value))} characters are too many; give at most {context['max_length']}."
        case "too_long":
            return f"{place}: {len(item['input'])} is too many; give at most {context['max_length']}."
        case _:
            allowed = _ALLOWED.get(kind) or item["msg"].replace("Input should be ", "")
            return f"{place}: {shown} is not allowed here; it must be {allowed}."


def _others(place: str) -> str:
    """Where a section can be that plug-ins add, the way to see which are installed."""
    may_be = re.fullmatch(r"faults\[\d+\]|(background|machine_conditions|sensor_faults)\.\w+", place)
    return "; one of a plug-in needs it installed, and raceway doctor lists those" if may_be else ""


_ALLOWED = {
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "string_type": "text, in quotes if it is a number",
    "string_pattern_mismatch": "1 to 64 letters, digits, dots, dashes or underscores",
    "int_parsing": "a whole number",
    "float_parsing": "a number",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "tuple_type": "a list",
    "model_type": "a section with keys of its own",
    "model_attributes_type": "a section with keys of its own",
    "dict_type": "a section with keys of its own",
}


def _place(location: tuple[int | str, ...], model: type[BaseModel]) -> str:
    """Path of a value in the file; the names of union branches, which pydantic inserts, are left out."""
    place, node = "", _Cursor(model)
    # pydantic marks a key that is wrong as a value: the place is that of its section
    for step in location[:-2] if location[-1:] == ("[key]",) else location:
        if isinstance(step, int):
            place += f"[{step}]"
        elif node.branches(step):
            node = node.of_kind(step)
        elif place and any(step in getattr(section, "arguments", ()) for section in node.models):
            node = node.into(step)  # a number, or a list, that stands for a distribution without its key
        elif node.knows(step) or not node.models or step not in _branches():
            shown = step if step.isprintable() and len(step) <= _LONGEST_KEY else reprlib.repr(step)
            place += f".{shown}" if place else shown
            node = node.into(step)
    return place


@functools.cache
def _branches() -> set[str]:
    """Values of ``kind`` of every section and distribution, which are steps of a location, and no keys."""
    models = BaseModel.__subclasses__()
    for model in models:  # the list grows
        models += model.__subclasses__()
    return {kind for model in models for kind in kinds_of(model)}


class _Cursor:
    """Sections that a location can lead to so far."""

    def __init__(self, *models: type[BaseModel]) -> None:
        self.models = models

    def knows(self, key: str) -> bool:
        return any(key in model.model_fields for model in self.models)

    def branches(self, step: str) -> bool:
        """Whether a step is the kind of one of several sections, also if it is a key too: ``ball``."""
        return len(self.models) > 1 and self.of_kind(step) is not self

    def into(self, key: str) -> "_Cursor":
        fields = [model.model_fields[key] for model in self.models if key in model.model_fields]
        return _Cursor(*(model for field in fields for model in models_in(field.annotation)))

    def of_kind(self, kind: str) -> "_Cursor":
        sections = [model for model in self.models if kind in kinds_of(model)]
        return _Cursor(*sections) if sections else self

    def keys(self) -> list[str]:
        fields = [item for model in self.models for item in model.model_fields.items()]
        return sorted({name for key, field in fields for name in (key, *_other_names(field))})


def _other_names(field: FieldInfo) -> list[Any]:
    return field.validation_alias.choices if isinstance(field.validation_alias, AliasChoices) else []


def models_in(annotation: Any) -> list[type[BaseModel]]:
    """Models that a value of a type can be, or can be made of."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for argument in get_args(annotation) for model in models_in(argument)]


def _siblings(location: tuple[int | str, ...], model: type[BaseModel]) -> list[str]:
    """Keys that are allowed where ``location`` ends."""
    return _last(location[:-1], model).keys()


def _last(location: tuple[int | str, ...], model: type[BaseModel]) -> _Cursor:
    """Sections that ``location`` leads to."""
    node = _Cursor(model)
    for step in location:
        if isinstance(step, str):
            node = node.into(step) if node.knows(step) and not node.branches(step) else node.of_kind(step)
    return node


def kinds_of(model: type[BaseModel]) -> tuple[str, ...]:
    """Values of ``kind`` of a section; none if it has no kinds."""
    return get_args(model.model_fields["kind"].annotation) if "kind" in model.model_fields else ()


def _guess(location: tuple[int | str, ...], model: type[BaseModel]) -> str | None:
    """Allowed key that is most similar to the last key of ``location``, if any."""
    key, allowed = str(location[-1]), _siblings(location, model)
    # rpm is the end of shaft_rpm, which is nearer than nominal_rpm
    near = sorted((name for name in allowed if name.endswith(f"_{key}")), key=len) or difflib.get_close_matches(
        key, allowed, 1
    )
    return near[0] if near else None
