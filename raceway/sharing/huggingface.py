"""Layout of a data set of the Hugging Face hub: Parquet files by split, and a card that names their features.

``datasets.load_dataset(folder)`` reads it, also without a network. Texts in the header of the card are written as JSON, which is YAML too,
so that a title from a stranger stays a text.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from gen.corpus.schema import SPLITS
from raceway.sharing.card.markdown import plain_text
from raceway.sharing.form_columns import Column, Export
from raceway.sharing.parquet_files import known_classes, write_shards

_LICENCES = (
    "apache-2.0", "bsd-2-clause", "bsd-3-clause", "cc0-1.0", "cc-by-4.0", "cc-by-nc-4.0", "cc-by-nc-nd-4.0", "cc-by-nc-sa-4.0",
    "cc-by-nd-4.0", "cc-by-sa-4.0", "mit", "odbl", "pddl",
)  # fmt: skip
"""Identifiers of the hub; any other licence is given by its name."""


def write_huggingface(export: Export, folder: Path) -> str:
    """Write ``data/train-00000-of-00002.parquet`` ... and the card ``README.md``; returns the card."""
    split = export.chosen.values("split")
    sizes = {}
    for code, name in enumerate(SPLITS):
        places = np.flatnonzero(split == code)
        if len(places):
            write_shards(export, folder / "data", name, places, names=False)
            sizes[name] = len(places)
    return _card(export, sizes)


def _card(export: Export, sizes: dict[str, int]) -> str:
    """Card of the data set: a YAML header, and a page with the meaning of each column."""
    columns = ["| column | unit | role | meaning |", "|---|---|---|---|"]
    for column in export.columns:
        cells = map(plain_text, (column.units, column.role, column.meaning))
        columns.append(f"| `{column.name}` | " + " | ".join(cells) + " |")
    reading = _READING.format(channel=export.channels[0], split=next(iter(sizes)))
    return "\n".join([_header(export, sizes), export.page(reading), *columns, ""])


def _header(export: Export, sizes: dict[str, int]) -> str:
    """YAML header; every value below the upper keys is JSON on a line of its own."""
    # JSON is YAML, so that no text of a corpus can become a key
    facts: dict[str, str] = {
        "pretty_name": export.title,
        **_licence(str(export.chosen.attributes.get("license", ""))),
    }
    tags = ["vibration", "bearing", "fault-diagnosis", "condition-monitoring"]
    return "\n".join(
        [
            "---",
            *(f"{key}: {_json(value)}" for key, value in facts.items()),
            f"tags: {_json(tags)}",
            f"size_categories: {_json([_size_category(sum(sizes.values()))])}",
            "configs:",
            "- config_name: default",
            "  data_files:",
            *(f"  - {_json({'split': name, 'path': f'data/{name}-*.parquet'})}" for name in sizes),
            "dataset_info:",
            "  config_name: default",
            "  features:",
            *(f"  - {_json(feature)}" for feature in _features(export)),
            "---",
            "",
        ]
    )


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)


def _licence(text: str) -> dict[str, str]:
    """Keys for a licence, given by its SPDX identifier with an address behind it.

    >>> _licence("CC-BY-4.0 (https://spdx.org/licenses/CC-BY-4.0.html)"), _licence("Proprietary")
    ({'license': 'cc-by-4.0'}, {'license': 'other', 'license_name': 'Proprietary'})
    """
    name = text.partition(" (")[0]
    if name.lower() in _LICENCES:
        return {"license": name.lower()}
    return {"license": "other", "license_name": plain_text(text)} if text else {}


def _size_category(records: int) -> str:
    """Class of size that the hub shows.

    >>> _size_category(999), _size_category(20_000)
    ('n<1K', '10K<n<100K')
    """
    bounds = {"1K": 1e3, "10K": 1e4, "100K": 1e5, "1M": 1e6, "10M": 1e7, "100M": 1e8}
    names = list(bounds)
    place = int(np.searchsorted(list(bounds.values()), records, side="right"))
    return "n<1K" if place == 0 else f"{names[place - 1]}<n<{names[min(place, len(names) - 1)]}"


def _features(export: Export) -> list[dict[str, Any]]:
    """Names and types of all columns, as ``datasets.Features`` writes them in a card."""
    labels = [{"name": column.name, "dtype": _dtype(column)} for column in export.columns]
    signals = [
        {"name": f"acceleration_{name}", "list": "float32", "length": export.chosen.samples} for name in export.channels
    ]
    return [{"name": "record", "dtype": "int64"}, *labels, *signals]


def _dtype(column: Column) -> Any:
    if column.flags:
        names = known_classes(column).values()
        return {"class_label": {"names": {str(place): plain_text(name) for place, name in enumerate(names)}}}
    return "string" if column.dtype is None else str(column.dtype)


_READING = """\
    import os, datasets
    records = datasets.load_dataset(os.getcwd())  # the full path of this folder, or its name on the hub
    signal = records["{split}"].with_format("numpy")[0]["acceleration_{channel}"]  # m s-2
    name = records["{split}"].features["fault"].int2str(records["{split}"][0]["fault"])

A fault that is not known is null.
"""
