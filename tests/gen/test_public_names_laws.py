"""Laws of the public names: each is the object of its module, in whatever order modules are imported, and loads only what it needs."""

import inspect
import subprocess
import sys

import pytest

import features
import gen
import gen.corpus

HEAVY = {"numba", "distributed", "scipy.stats", "sklearn", "matplotlib"}


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("package", [gen, gen.corpus, features], ids=lambda package: package.__name__)
def test_every_public_name_is_there_and_listed(package):
    assert set(package.__all__) <= set(dir(package))
    for name in package.__all__:
        found = getattr(package, name)
        if inspect.isfunction(found) or inspect.isclass(found):
            assert found.__name__ == name


@pytest.mark.parametrize("package", [gen, gen.corpus, features], ids=lambda package: package.__name__)
def test_an_unknown_name_is_an_attribute_error(package):
    with pytest.raises(AttributeError, match=f"No {package.__name__} attribute frobnicate"):
        _ = package.frobnicate


@pytest.mark.parametrize(
    "order",
    [
        ("gen.generation.corpus", "gen.generation.replaying"),
        ("gen.generation.replaying", "gen.generation.corpus"),
        ("gen.generation.plan", "gen.generation.replaying"),
    ],
    ids=" then ".join,
)
def test_a_public_name_is_the_function_after_the_import_of_any_module(order):
    imports = "; ".join(f"import {name}" for name in order)
    names = "gen.generate.__module__, gen.replay.__module__, gen.read_recipe.__module__"
    expected = "gen.generation.corpus gen.generation.replaying gen.recipe.reading\n"
    assert run(f"{imports}; from gen import generate, replay; print({names})") == expected
    assert run(f"from gen import generate, replay; {imports}; print({names})") == expected


def test_no_public_name_is_the_name_of_a_module():
    for package in (gen, features):
        listed = {line.split()[0] for line in package.__doc__.splitlines() if line[:1].isalpha()}
        assert not listed & set(package.__all__)


@pytest.mark.parametrize("module", ["gen", "gen.corpus", "features"])
def test_reading_a_corpus_loads_neither_the_simulator_nor_the_classifiers(module):
    assert run(f"import sys, {module}; print(*({HEAVY!r} & set(sys.modules)))") == "\n"
