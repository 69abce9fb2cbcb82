"""The distributions hold everything they should."""

import shutil
import subprocess
import sys
import tarfile
import zipfile
from importlib.metadata import version

import pytest
from packaging.version import Version

from tests.paths import ROOT
from tests.test_packaging import FILES, FOLDERS, IMPORTED


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
