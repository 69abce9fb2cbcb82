"""A small recipe and its corpus in both forms, made once."""

import shutil

import pytest

from gen.generation.corpus import generate


@pytest.fixture(scope="session")
def recipe_file(write_recipe, tmp_path_factory):
    return write_recipe(tmp_path_factory.mktemp("recipe") / "small.yaml")


@pytest.fixture(scope="session")
def whole(recipe_file, tmp_path_factory):
    """The small corpus: three parts of eight records."""
    folder = tmp_path_factory.mktemp("whole") / "corpus"
    return generate(recipe_file, folder)


@pytest.fixture(scope="session")
def single(recipe_file, tmp_path_factory):
    """The small corpus in a single file."""
    return generate(recipe_file, tmp_path_factory.mktemp("single") / "corpus.nc")


@pytest.fixture
def copied(whole, tmp_path):
    return shutil.copytree(whole.path, tmp_path / "copy")
