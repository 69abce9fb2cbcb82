"""JSON schema of a recipe, for editors that complete and check keys.

pydantic writes the schema of the sections. Added here: ranges of quantities, entries of `faults` that leave keys to the defaults, and the
choice among forms of a value by their type, and among sections by their `kind`, so that an error names the key that is wrong.
"""

import json
from collections.abc import Mapping
from typing import Any

from gen.recipe.model import Recipe


def recipe_schema() -> str:
    """JSON schema that accepts every recipe of :func:`gen.read_recipe`, and refuses keys and values that are wrong by themselves."""
    schema = Recipe.model_json_schema()
    definitions = schema["$defs"]
    for section in (schema, *definitions.values()):
        for described in section.get("properties", {}).values():
            if "open_low" in described:
                _add_range(described)
    entries = definitions["FaultList"]["properties"]["entries"]
    entries["items"] = _with_defaults(entries["items"], definitions)
    _choose(schema, definitions)
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}, indent=1) + "\n"


def _add_range(quantity: dict[str, Any]) -> None:
    """Give the number and the list of a quantity its range; a quantity that is not drawn for each item takes no list."""
    low, high, open_low, whole, each = (quantity.pop(key, None) for key in ("low", "high", "open_low", "whole", "each"))
    number = {
        "type": "integer" if whole else "number",
        ("exclusiveMinimum" if open_low else "minimum"): low,
        "maximum": high,
    }
    forms = {"number": number, "array": {"type": "array", "items": number}}
    quantity["anyOf"] = [forms.get(form["type"], form) for form in quantity["anyOf"] if each or form["type"] != "array"]


def _choose(schema: Any, definitions: dict[str, Any]) -> None:
    """Put conditions in place of all unions, at any depth: on the `kind` of a section, or on the type of a value."""
    if isinstance(schema, dict):
        union, forms = (schema.pop(key, None) for key in ("discriminator", "anyOf"))
        if union is not None:
            del schema["oneOf"]
            schema |= _by_kind({kind: {"$ref": place} for kind, place in union["mapping"].items()})
        elif forms is not None:
            schema |= _by_type(forms, definitions)
    for inner in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        _choose(inner, definitions)


def _by_type(forms: list[dict[str, Any]], definitions: dict[str, Any]) -> dict[str, Any]:
    """Forms of a value by its type, and the last section for a value that fits none; a section before it by its kind."""
    *others, schema = sorted(forms, key=lambda form: "type" not in form)
    for form in reversed(others):
        if "type" in form:
            condition = {"type": "number" if form["type"] == "integer" else form["type"]}
        else:  # a bearing by its dimensions may leave its kind out, and is the last form
            condition = _of_kind(definitions[form["$ref"].rpartition("/")[2]]["properties"]["kind"]["const"])
        schema = {"if": condition, "then": form, "else": schema}
    return schema


def _by_kind(sections: Mapping[str, Any]) -> dict[str, Any]:
    conditions = [{"if": _of_kind(kind), "then": section} for kind, section in sections.items()]
    kinds = {"kind": {"enum": [*sections]}}
    return {"type": "object", "required": ["kind"], "properties": kinds, "allOf": conditions}


def _of_kind(kind: str) -> dict[str, Any]:
    return {"properties": {"kind": {"const": kind}}, "required": ["kind"]}


def _with_defaults(union: dict[str, Any], definitions: dict[str, Any]) -> dict[str, Any]:
    """Union of faults that may leave all keys to the defaults, except those that defaults cannot give."""
    faults: dict[str, Any] = {}
    for kind, place in union["discriminator"]["mapping"].items():
        fault = definitions[place.rpartition("/")[2]]
        keys = dict(fault["properties"])
        if "parts" in keys:
            keys["parts"] = {**keys["parts"], "items": _with_defaults(keys["parts"]["items"], definitions)}
        needed = [key for key in fault["required"] if key in ("kind", "parts")]
        faults[kind] = {**fault, "properties": keys, "required": needed}
    return _by_kind(faults)
