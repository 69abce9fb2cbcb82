"""The distributions hold everything they should, and what pyproject.toml states is true of the project."""

import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from importlib.metadata import version

import pytest
from packaging.specifiers import SpecifierSet
from packaging.version import Version

from tests.floors import floors
from tests.paths import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
IMPORTED = ("gen", "features", "raceway")
FOLDERS = (*IMPORTED, "recipes", "benchmarks", "docs", "tests")
FILES = (
    *("pyproject.toml", "MANIFEST.in", "Makefile", "LICENSE", "CITATION.cff"),
    *("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"),
)
PAGES = [path.relative_to(ROOT) for path in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("recipes/*.md"))]
LINK = re.compile(r"\]\((?![a-z]+:|#)([^)#]+)")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Names in the source distribution and in the wheel that is built from it."""
    pytest.importorskip("build")
    if Version(version("setuptools")) < Version("77"):
        pytest.skip("setuptools before 77 cannot build the project")
    tree, out = tmp_path_factory.mktemp("tree"), tmp_path_factory.mktemp("out")
    for name in FOLDERS:
        shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in FILES:
        shutil.copy(ROOT / name, tree / name)
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", out, tree]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    with tarfile.open(next(out.glob("*.tar.gz"))) as source, zipfile.ZipFile(next(out.glob("*.whl"))) as wheel:
        return {name.partition("/")[2] for name in source.getnames()}, set(wheel.namelist())


def tree_files():
    """Every file of the project's folders, by its path from the root."""
    found = {path.relative_to(ROOT) for name in FOLDERS for path in (ROOT / name).rglob("*") if path.is_file()}
    return {path.as_posix() for path in found if "__pycache__" not in path.parts}


def test_the_source_distribution_holds_every_file_of_the_project(built):
    assert tree_files() | set(FILES) <= built[0]


def test_the_wheel_holds_every_module_recipe_and_type_marker_and_no_test(built):
    wanted = {name for name in tree_files() if name.split("/")[0] in IMPORTED}
    wanted |= {f"raceway_recipes/{path.name}" for path in (ROOT / "recipes").iterdir() if path.suffix != ".md"}
    wanted -= {"raceway_recipes/__pycache__"}
    assert wanted <= built[1]
    assert {name.split("/")[0] for name in built[1]} == {
        *IMPORTED,
        "raceway_recipes",
        f"raceway-{version('raceway')}.dist-info",
    }


def test_no_package_is_missing_from_the_list_in_pyproject():
    found = {path.parent.relative_to(ROOT) for name in IMPORTED for path in (ROOT / name).rglob("*.py")}
    assert {".".join(path.parts) for path in found} | {"raceway_recipes"} == set(
        PROJECT["tool"]["setuptools"]["packages"]
    )


def test_every_package_is_marked_as_typed():
    assert all((ROOT / name / "py.typed").is_file() for name in IMPORTED)


def test_the_classifiers_name_the_oldest_python_and_the_tools_use_it():
    named = re.findall(r"Python :: (3\.\d+)$", "\n".join(PROJECT["project"]["classifiers"]), re.MULTILINE)
    assert all(Version(minor) in SpecifierSet(PROJECT["project"]["requires-python"]) for minor in named)
    assert f">={named[0]}" == PROJECT["project"]["requires-python"]
    assert PROJECT["tool"]["basedpyright"]["pythonVersion"] == named[0]
    assert PROJECT["tool"]["ruff"]["target-version"] == "py" + named[0].replace(".", "")


def test_the_installed_packages_are_not_below_their_floors():
    too_old = {name: floor for name, floor in floors().items() if Version(version(name)) < Version(floor)}
    assert too_old == {}


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_every_relative_link_of_a_page_leads_to_a_file_of_the_project(page):
    folder = (ROOT / page).parent
    targets = [(folder / link).resolve() for link in LINK.findall((ROOT / page).read_text(encoding="utf-8"))]
    assert [target for target in targets if not target.is_relative_to(ROOT) or not target.is_file()] == []
    names = [target.relative_to(ROOT).as_posix() for target in targets]
    assert [name for name in names if name not in FILES and name.split("/")[0] not in FOLDERS] == []
