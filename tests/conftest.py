"""The examples of laws, two small recipes, and corpora of them."""

import copy
import io
import shutil
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any, BinaryIO

import pytest
import xarray as xr
from distributed import Client
from hypothesis import settings
from matplotlib.figure import Figure
from ruamel.yaml import YAML

from features import feature_table
from features.baselines.estimators import MAKERS, logistic_regression
from gen import generate
from gen.drawing.section import plain
from gen.recipe import Recipe
from gen.support import cluster
from gen.support.executor import connected
from tests import corpora
from tests.worker_processes import SHARED, worker_processes

# `make test` passes or fails on the same examples each time, so few of them are enough; `make thorough` tries a hundred fresh ones.
# No deadline: it fails on a loaded machine.
settings.register_profile("same", derandomize=True, max_examples=15, deadline=None)
settings.register_profile("fresh", print_blob=True, deadline=None)
settings.load_profile("same")

TINY = """\
# Tiny: four classes on two machines, for tests.
name: tiny
title: Tiny corpus
seed: 3
corpus: {rigs: 2, specimens_per_rig: 8, records_per_specimen: 3, split: {test: 0.25}}
storage: {records_per_part: 12}
recording: {sample_rate_hz: 12000, duration_s: 0.1, settle_s: 0.05}
bearing: {kind: catalogue, designations: ["6205"]}
specimen: {waviness_nm: 20}
operation: {shaft_rpm: 'uniform(4500, 6000)'}
faults:
  - {kind: healthy}
  - {kind: inner, width_mm: 'uniform(0.5, 1)'}
  - {kind: outer, width_mm: 'uniform(0.5, 1)'}
  - {kind: ball, width_mm: 'uniform(0.5, 1)'}
"""


@pytest.fixture
def unpainted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures are drawn but not painted: most of the time of a page, in tests of its text, of scores and of files."""

    def save(_figure: Figure, stream: BinaryIO, **options: Any) -> None:
        stream.write(f"a picture as {options['format']}".encode())

    monkeypatch.setattr(Figure, "savefig", save)


@pytest.fixture(scope="module")
def few_trees() -> Iterator[None]:
    """Forests of ten trees and ten rounds of boosting: what is tested is true for those of any size."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("features.baselines.estimators.TREES", 10)
        patch.setattr("features.baselines.estimators.ROUNDS", 10)
        patch.setattr("gen.support.executor.cores", lambda: 1)  # processes would train whole forests
        yield


@pytest.fixture(scope="module")
def quick_estimators() -> Iterator[None]:
    """Logistic regression in place of every baseline that takes longer to fit: what is tested is true for any classifier."""
    with pytest.MonkeyPatch.context() as patch:
        for name in MAKERS.keys() - {"majority", "envelope_rule"}:
            patch.setitem(MAKERS, name, logistic_regression)
        patch.setattr("gen.support.executor.cores", lambda: 1)  # processes would fit the whole baselines
        yield


@pytest.fixture(scope="session")
def two_processes() -> Iterator[Client]:
    """Client of two processes, started once: it takes seconds until they have loaded the simulator."""
    with connected(2, "gen.generation.make_part") as client:
        assert isinstance(client, Client)
        client.wait_for_workers(2)
        SHARED.update(worker_processes())
        yield client
    SHARED.clear()


@pytest.fixture
def started_processes(two_processes: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """Calls with two workers find their processes started; who starts and ends them is tested in test_executor_laws.py."""
    client_of = cluster.client_of

    def started(place: Client | str | int, *how: str) -> AbstractContextManager[Client]:
        return nullcontext(two_processes) if place == 2 else client_of(place, *how)

    monkeypatch.setattr(cluster, "client_of", started)


@pytest.fixture(scope="session")
def tiny_recipe(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """File of a recipe with 48 records of 0.1 s in four parts."""
    path = tmp_path_factory.mktemp("recipe") / "tiny.yaml"
    path.write_text(TINY, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def tiny_corpus(tiny_recipe: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the corpus of ``tiny_recipe``; copy it before changing anything in it."""
    return generate(tiny_recipe, tmp_path_factory.mktemp("tiny") / "corpus").path


@pytest.fixture(scope="session")
def tiny_table(tiny_corpus: Path) -> xr.Dataset:
    """Feature table of ``tiny_corpus``; copy it before changing anything in it."""
    return feature_table(tiny_corpus)


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
