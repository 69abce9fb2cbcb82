"""A small recipe that the tests of generation share, and ways to change it."""

import copy
import io
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from gen.drawing.section import plain
from gen.recipe import Recipe
from tests import corpora

RecipeWith = Callable[..., Recipe]

SMALL: dict[str, Any] = {
    "name": "small",
    "title": "A small corpus for tests",
    "seed": 3,
    "corpus": {
        "rigs": 3,
        "specimens_per_rig": 4,
        "records_per_specimen": 2,
        "split": {"by": "specimen", "test": 0.25},
    },
    "storage": {"records_per_part": 8},
    "recording": {
        "sample_rate_hz": 12000,
        "duration_s": 0.1,
        "settle_s": 0.06,
        "channels": [{"name": "sensor", "body": "sensor"}],
    },
    "bearing": {"kind": "catalogue", "designations": ["6205"]},
    "machine": {
        "shaft_mass_kg": "loguniform(2, 8)",
        "support_frequency_hz": "uniform(200, 500)",
        "resonator": {"frequency_hz": "uniform(2500, 3500)"},
    },
    "specimen": {"diametral_clearance_um": "uniform(-4, 12)", "waviness_nm": 20},
    "operation": {
        "shaft_rpm": "uniform(1500, 2000)",
        "load_n": "loguniform(100, 1000)",
        "mean_slip_percent": 0.5,
        "spin_wander_percent": 0.5,
    },
    "faults": [
        {"kind": "healthy"},
        {"kind": "inner", "width_mm": 0.5, "angle_deg": "uniform(0, 360)"},
        {"kind": "outer", "width_mm": 0.5, "angle_deg": "uniform(-40, 40)"},
        {"kind": "ball", "width_mm": 0.5, "axis_wander_deg": 4},
    ],
    "path": {"direct": 0.3, "modes": {"count": 2, "frequency_hz": "uniform(500, 5000)", "damping_percent": 3}},
    "background": {
        "slope": "uniform(0, 1)",
        "harmonics": {"probability": 0.8, "count": 3, "level_db": -10},
        "tones": {"probability": 0.8, "count": 2, "frequency_hz": "loguniform(50, 4000)", "level_db": -10},
        "impulses": {"probability": 0.5, "rate_hz": 20, "level_db": 10},
    },
}  # fmt: skip


def small_with(changes: dict[str, Any]) -> dict[str, Any]:
    """The small recipe with some values, named by their path (``corpus.rigs``), replaced."""
    data = copy.deepcopy(SMALL)
    for path, value in changes.items():
        *sections, key = path.split(".")
        section = data
        for name in sections:
            section = section.setdefault(name, {})
        section[key] = value
    return data


@pytest.fixture(scope="session")
def nine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder that holds one corpus of nine random records as a folder, ``c``, and as a file, ``c.nc``; change copies alone."""
    place = tmp_path_factory.mktemp("nine")
    for form in ("c", "c.nc"):
        corpora.write_corpus(place / form)
    return place


@pytest.fixture
def copied_folder(nine: Path, tmp_path: Path) -> Path:
    """Copy of the folder of nine records."""
    return shutil.copytree(nine / "c", tmp_path / "copy")


@pytest.fixture
def copied_file(nine: Path, tmp_path: Path) -> Path:
    """Copy of the file of nine records."""
    return Path(shutil.copyfile(nine / "c.nc", tmp_path / "copy.nc"))


@pytest.fixture(scope="session")
def recipe_with() -> RecipeWith:
    """Make the small recipe with some values replaced: ``recipe_with({"corpus.rigs": 2})``."""
    return lambda changes=None: Recipe.model_validate(small_with(changes or {}))


@pytest.fixture(scope="session")
def write_recipe() -> Callable[..., Path]:
    """Write the small recipe, with some values replaced, to a path."""

    def write(path: Path, changes: dict[str, Any] | None = None) -> Path:
        stream = io.StringIO()
        YAML(typ="safe", pure=True).dump(plain(small_with(changes or {})), stream)
        path.write_text(stream.getvalue(), encoding="utf-8")
        return path

    return write
