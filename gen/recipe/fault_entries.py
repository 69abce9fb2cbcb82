"""``faults`` with ``defaults``: keys that all entries have unless they give them, so that nothing is written twice."""

import difflib
from collections.abc import Mapping
from typing import Any

from pydantic import ConfigDict

from gen.drawing import Section
from gen.recipe.faults import OF_KIND, Fault


class FaultList(Section):
    """Entries of ``faults``, and the keys that they have in common."""

    model_config = ConfigDict(title="faults with defaults")

    defaults: dict[str, Any]
    """Keys of entries; each entry whose kind has the key takes it, unless it gives another value."""
    entries: tuple[Fault, ...]
    """Faults that specimens can have."""


def fault_entries(value: Any) -> Any:
    """Entries of ``faults`` with their defaults filled in; a list of entries is returned as it is.

    >>> fault_entries({"defaults": {"width_mm": 1, "depth_um": 50}, "entries": [{"kind": "inner", "width_mm": 2}, {"kind": "healthy"}]})
    [{'width_mm': 2, 'depth_um': 50, 'kind': 'inner'}, {'kind': 'healthy'}]
    """
    if not isinstance(value, Mapping):
        return value
    if value.keys() != {"defaults", "entries"} or not isinstance(value["defaults"], Mapping):
        raise ValueError("has the keys defaults (keys that entries have in common) and entries (a list), or is a list.")
    defaults, entries = value["defaults"], value["entries"]
    if not isinstance(entries, list | tuple) or not all(isinstance(entry, Mapping) for entry in entries):
        return entries
    keys = {key for entry in entries for fault in (entry, *_parts(entry)) for key in _keys(fault)}
    unknown = next((key for key in defaults if key not in keys), None)
    if unknown is not None:
        near = difflib.get_close_matches(str(unknown), keys, 1)
        raise ValueError(
            f"defaults: {unknown} is a key of no entry" + (f"; did you mean {near[0]}?" if near else "; leave it out.")
        )
    return [_filled(entry, defaults) for entry in entries]


def _filled(entry: Any, defaults: Mapping[str, Any]) -> Any:
    if not isinstance(entry, Mapping):
        return entry
    parts = {"parts": [_filled(part, defaults) for part in entry["parts"]]} if _parts(entry) else {}
    return {key: value for key, value in defaults.items() if key in _keys(entry)} | dict(entry) | parts


def _parts(entry: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Faults of which an entry consists."""
    parts = entry.get("parts")
    return [part for part in parts if isinstance(part, Mapping)] if isinstance(parts, list | tuple) else []


def _keys(entry: Mapping[str, Any]) -> set[str]:
    model = OF_KIND.get(str(entry.get("kind")))
    return set() if model is None else set(model.model_fields) - {"kind", "parts"}
