"""Small feature tables to train models on, and the members of model files."""

import json
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import xarray as xr

from features.baselines import ESTIMATORS, Model, estimators
from features.table.class_features import EVIDENCE

NAMES = (*EVIDENCE, "raw_kurtosis")


def make_table(classes: int = 3, records: int = 24, seed: int = 0, names: Sequence[str] = NAMES) -> xr.Dataset:
    """Feature table whose features depend weakly on the class; each record has its own specimen."""
    rng = np.random.default_rng(seed)
    fault = (np.arange(records) % classes).astype(np.int8)
    features = rng.standard_normal((records, len(names))) + fault[:, None]
    known = dict.fromkeys(("rig", "specimen", "recording"), ("record", np.arange(records)))
    return xr.Dataset(
        {"features": (("record", "feature"), features), "fault": ("record", fault), **known},
        {
            "feature": np.array(names, dtype=object),
            "group": ("feature", np.array(["lines"] * (len(names) - 1) + ["shape"], dtype=object)),
        },
        {"title": "a made-up corpus"},
    )


def write_models(folder: Path, classes: int, seed: int = 0) -> dict[str, Path]:
    """Write a model file of every estimator, of two trees or two rounds."""
    paths = {name: folder / f"{name}_{classes}.skops" for name in ESTIMATORS}
    with mock.patch.multiple(estimators, TREES=2, ROUNDS=2):
        for name, path in paths.items():
            Model(name, seed=seed).fit(make_table(classes)).save(path)
    return paths


class Archive:
    """Members of a model file, to be examined, or changed and zipped again with the right checksums."""

    def __init__(self, path: Path) -> None:
        with zipfile.ZipFile(path) as archive:
            self.members = {name: archive.read(name) for name in archive.namelist()}
        self.schema = json.loads(self.members.pop("schema.json"))

    def values(self) -> list[Any]:
        """Every part of the schema, outermost first."""
        found: list[Any] = [self.schema]
        for value in found:
            found += list(value.values()) if isinstance(value, dict) else value if isinstance(value, list) else []
        return found

    def places(self, key: str) -> list[dict]:
        """Every JSON object under a key, outermost first."""
        return [value[key] for value in self.values() if isinstance(value, dict) and isinstance(value.get(key), dict)]

    def field(self, name: str) -> dict:
        return self.schema["content"][name]

    def write(self, path: Path) -> Path:
        with zipfile.ZipFile(path, "w") as archive:
            for name, content in {**self.members, "schema.json": json.dumps(self.schema).encode()}.items():
                archive.writestr(name, content)
        return path
