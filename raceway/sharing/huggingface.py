"""Layout of a data set of the Hugging Face hub: a Parquet file for each split, and a card that names their features.

``datasets.load_dataset(folder)`` reads it, also without a network. Texts in the header of the card are written as JSON, which is YAML too,
so that a title from a stranger stays a text.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from gen.corpus.schema import DRAWS, SPLITS
from raceway.sharing.card.markdown import plain_text
from raceway.sharing.copying import Chosen
from raceway.sharing.form_columns import Column, columns_of, plain_names
from raceway.sharing.parquet_files import SIGNAL_PREFIX, write_parquet

_LICENCES = (
    "apache-2.0", "bsd-2-clause", "bsd-3-clause", "cc0-1.0", "cc-by-4.0", "cc-by-nc-4.0", "cc-by-nc-nd-4.0", "cc-by-nc-sa-4.0",
    "cc-by-nd-4.0", "cc-by-sa-4.0", "mit", "odbl", "pddl",
)  # fmt: skip
"""Identifiers of the hub; any other licence is given by its name."""
_TERMS = {"license": "Licence", "creator_name": "Creators", "references": "References", "metadata_link": "Published at"}
"""Global attributes that the card repeats, with their headings."""


def write_huggingface(chosen: Chosen, folder: Path) -> None:
    """Write ``data/train.parquet`` ... and the card ``README.md``."""
    (folder / "data").mkdir()
    code, sizes = chosen.values("split"), {}
    for number, split in enumerate(SPLITS):
        places = np.flatnonzero(code == number)
        if len(places):
            write_parquet(chosen, folder / "data" / f"{split}.parquet", places)
            sizes[split] = len(places)
    columns = columns_of(chosen)
    card = f"{_header(chosen, columns, sizes)}\n{_page(chosen, columns, next(iter(sizes)))}\n"
    (folder / "README.md").write_text(card, encoding="utf-8")


def _page(chosen: Chosen, columns: list[Column], split: str) -> str:
    """Origin of the records, their size, how to read them, and the meaning of each column."""
    signal = f"{chosen.samples / chosen.sample_rate:g} s at {chosen.sample_rate:g} Hz"
    channels = ", ".join(map(plain_text, chosen.channels))
    count = f"{chosen.count} of {chosen.of} records of {'a corpus' if len(chosen.paths) == 1 else f'{len(chosen.paths)} corpora'}"
    about = f"{count}, {signal}, channels {channels}, in m s-2, copied by Raceway. `record` is the number of the record in the source."
    lines = [f"# {_title(chosen)}", "", about]
    for name, heading in _TERMS.items():
        text = plain_text(chosen.attributes.get(name, ""))
        lines += ["", f"{heading}: {text}"] if text else []
    lines += ["", _READING.format(signal=f"{SIGNAL_PREFIX}{plain_names(chosen.channels)[0]}", split=split)]
    lines += ["| column | unit | role | meaning |", "|---|---|---|---|"]
    for column in columns:
        cells = map(plain_text, (column.units, column.role, column.meaning))
        lines.append(f"| `{column.name}` | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _title(chosen: Chosen) -> str:
    """Title as one harmless line."""
    return plain_text(chosen.title) or "Vibration records of rolling bearings"


def _header(chosen: Chosen, columns: list[Column], sizes: dict[str, int]) -> str:
    """YAML header; every value below the upper keys is JSON on a line of its own."""
    # JSON is YAML, so that no text of a corpus can become a key
    simulated = [DRAWS in corpus.variables for corpus in chosen.corpora]
    facts: dict[str, Any] = {
        "pretty_name": _title(chosen),
        **_licence(str(chosen.attributes.get("license", ""))),
        "task_categories": ["tabular-classification"],  # the hub has no category of signals but sound
        "tags": ["vibration", "bearing", "fault-diagnosis", "condition-monitoring", *["synthetic"] * any(simulated)],
        # labels of recordings may be a person's
        **({"annotations_creators": ["machine-generated"], "source_datasets": ["original"]} if all(simulated) else {}),
        "size_categories": [_size_category(sum(sizes.values()))],
    }
    return "\n".join(
        [
            "---",
            *(f"{key}: {_json(value)}" for key, value in facts.items()),
            "configs:",
            "- config_name: default",
            "  data_files:",
            *(f"  - {_json({'split': name, 'path': f'data/{name}.parquet'})}" for name in sizes),
            "dataset_info:",
            "  config_name: default",
            "  features:",
            *(f"  - {_json(feature)}" for feature in _features(chosen, columns)),
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


def _features(chosen: Chosen, columns: list[Column]) -> list[dict[str, Any]]:
    """Names and types of all columns, as ``datasets.Features`` writes them in a card."""
    labels = [{"name": column.name, "dtype": _dtype(column)} for column in columns]
    signals = [
        {"name": f"{SIGNAL_PREFIX}{name}", "list": "float32", "length": chosen.samples}
        for name in plain_names(chosen.channels)
    ]
    return [{"name": "record", "dtype": "int64"}, *labels, *signals]


def _dtype(column: Column) -> Any:
    # the codes of the hub have no gaps: they are those of netCDF, and "unknown" follows the last class
    if column.flags:
        names = {str(place): plain_text(name) for place, name in enumerate(column.flags.values())}
        return {"class_label": {"names": names}}
    return "string" if column.dtype is None else str(column.dtype)


_READING = """\
    import os, datasets
    records = datasets.load_dataset(os.getcwd())  # the full path of this folder, or its name on the hub
    signal = records["{split}"].with_format("numpy")[0]["{signal}"]  # m s-2
    name = records["{split}"].features["fault"].int2str(records["{split}"][0]["fault"])
"""
