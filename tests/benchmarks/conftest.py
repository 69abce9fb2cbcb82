"""Recipes of the benchmarks, with records of a few hundredths of a second."""

from pathlib import Path

import pytest

from benchmarks.kernel import FULL, SEED
from benchmarks.pipeline import SHORT, variant
from gen.recipe import find_recipe

BRIEF = {"duration_s": 0.03, "settle_s": 0.05}


@pytest.fixture(scope="session")
def brief_seed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return variant(find_recipe(SEED), tmp_path_factory.mktemp("seed") / "seed.yaml", recording=BRIEF)


@pytest.fixture(scope="session")
def brief_full(tmp_path_factory: pytest.TempPathFactory) -> Path:
    corpus = {"rigs": 1, "specimens_per_rig": 6}
    path = tmp_path_factory.mktemp("full") / "full.yaml"
    machine = {"looseness_um": 2}  # it makes the kernel that of tests.recipes.EVERYTHING, which is compiled anyway
    return variant(
        FULL,
        path,
        corpus=corpus,
        storage={"records_per_part": 2},
        recording={"duration_s": 0.1, "settle_s": 0.05},
        machine=machine,
    )


@pytest.fixture(scope="session")
def few_short(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return variant(SHORT, tmp_path_factory.mktemp("short") / "short.yaml", storage={"records_per_part": 4})
