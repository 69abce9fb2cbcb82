"""JSON schema of a recipe, for editors that complete and check keys.

pydantic writes the schema of the sections. Added here: ranges of quantities, entries of `faults` that leave keys to the defaults, and the
choice among sections by their `kind`, of which an error names the key that is wrong and not the whole entry.
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
    _choose_by_kind(schema)
    # of a list the errors of its entries are told, and not that it is no mapping
    faults = schema["properties"]["faults"]
    listed, mapped = faults.pop("anyOf")
    faults |= {"if": {"type": "array"}, "then": listed, "else": mapped}
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}, indent=1) + "\n"


def _add_range(quantity: dict[str, Any]) -> None:
    """Give the number and the list of a quantity its range; a quantity that is not drawn for each item takes no list."""
    low, high, open_low, each = (quantity.pop(key, None) for key in ("low", "high", "open_low", "each"))
    number = {"type": "number", ("exclusiveMinimum" if open_low else "minimum"): low, "maximum": high}
    forms = {"number": number, "array": {"type": "array", "items": number}}
    quantity["anyOf"] = [forms.get(form["type"], form) for form in quantity["anyOf"] if each or form["type"] != "array"]


def _choose_by_kind(schema: Any) -> None:
    """Put a condition for each kind in place of all unions of sections that their `kind` tells apart, at any depth."""
    if isinstance(schema, dict):
        union = schema.pop("discriminator", None)
        if union is not None:
            del schema["oneOf"]
            schema |= _by_kind({kind: {"$ref": place} for kind, place in union["mapping"].items()})
    for inner in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        _choose_by_kind(inner)


def _by_kind(sections: Mapping[str, Any]) -> dict[str, Any]:
    conditions = [
        {"if": {"properties": {"kind": {"const": kind}}, "required": ["kind"]}, "then": section}
        for kind, section in sections.items()
    ]
    kinds = {"kind": {"enum": [*sections]}}
    return {"type": "object", "required": ["kind"], "properties": kinds, "allOf": conditions}


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
