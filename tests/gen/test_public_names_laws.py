"""Laws of the public names: each is the object of its module, in whatever order modules are imported, and loads only what it needs."""

import inspect
import subprocess
import sys

import pytest

import features
import gen
import gen.corpus

HEAVY = {"numba", "distributed", "scipy.stats", "sklearn", "matplotlib"}


@pytest.mark.parametrize("package", [gen, gen.corpus, features], ids=lambda package: package.__name__)
def test_every_public_name_is_there_and_listed(package):
    assert set(package.__all__) <= set(dir(package))
    for name in package.__all__:
        public = getattr(package, name)
        if inspect.isfunction(public) or inspect.isclass(public):
            assert public.__name__ == name


@pytest.mark.parametrize("package", [gen, gen.corpus, features], ids=lambda package: package.__name__)
def test_an_unknown_name_is_an_attribute_error(package):
    with pytest.raises(AttributeError, match=f"No {package.__name__} attribute frobnicate"):
        _ = package.frobnicate


def test_no_public_name_is_the_name_of_a_module():
    for package in (gen, features):
        listed = {line.split()[0] for line in package.__doc__.splitlines() if line[:1].isalpha()}
        assert not listed & set(package.__all__)


def test_reading_a_corpus_loads_neither_the_simulator_nor_the_classifiers():
    code = f"import sys, gen, gen.corpus, features; print(*({HEAVY!r} & set(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "\n"
