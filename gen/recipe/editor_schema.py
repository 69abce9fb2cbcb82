"""JSON schema of a recipe, for editors that complete and check keys.

pydantic writes the schema of the sections. Added here: ranges of quantities, and entries of `faults` that leave keys to the defaults.
"""

import json
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
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}, indent=1) + "\n"


def _add_range(quantity: dict[str, Any]) -> None:
    """Give the number and the list of a quantity its range; a quantity that is not drawn for each item takes no list."""
    low, high, open_low, each = (quantity.pop(key, None) for key in ("low", "high", "open_low", "each"))
    number = {"type": "number", ("exclusiveMinimum" if open_low else "minimum"): low, "maximum": high}
    forms = {"number": number, "array": {"type": "array", "items": number}}
    quantity["anyOf"] = [forms.get(form["type"], form) for form in quantity["anyOf"] if each or form["type"] != "array"]


def _with_defaults(union: dict[str, Any], definitions: dict[str, Any]) -> dict[str, Any]:
    """Union of faults that may leave all keys to the defaults, except those that defaults cannot give."""
    faults: list[dict[str, Any]] = []
    for reference in union["oneOf"]:
        fault = definitions[reference["$ref"].rpartition("/")[2]]
        keys = dict(fault["properties"])
        if "parts" in keys:
            keys["parts"] = {**keys["parts"], "items": _with_defaults(keys["parts"]["items"], definitions)}
        needed = [key for key in fault["required"] if key in ("kind", "parts")]
        faults.append({**fault, "properties": keys, "required": needed})
    return {"oneOf": faults}
