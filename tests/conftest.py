"""The examples of laws, a recipe whose corpus takes one or two seconds, and that corpus."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any, BinaryIO

import pytest
import xarray as xr
from distributed import Client
from hypothesis import settings
from matplotlib.figure import Figure

from features import feature_table
from features.baselines.estimators import ESTIMATORS, RELATIVE_ESTIMATORS
from gen import generate
from gen.support import cluster
from gen.support.executor import connected
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
        yield


@pytest.fixture(scope="module")
def quick_estimators() -> Iterator[None]:
    """Logistic regression in place of every baseline that takes longer to fit: what is tested is true for any classifier."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("svm", "random_forest", "extra_trees", "gradient_boosting", "ensemble"):
            patch.setitem(ESTIMATORS, name, ESTIMATORS["logistic_regression"])
        patch.setitem(RELATIVE_ESTIMATORS, "relative_ensemble", ESTIMATORS["logistic_regression"])
        yield


@pytest.fixture(scope="module")
def two_processes() -> Iterator[Client]:
    """Client of two processes, started once for a file: it takes seconds until they have loaded the simulator."""
    with connected(2, "gen.generation.parts") as client:
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
