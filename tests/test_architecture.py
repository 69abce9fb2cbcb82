"""The architecture is what the contracts in pyproject.toml and the package docstrings say it is."""

import importlib
import pkgutil
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from tests.paths import ROOT

PACKAGES = ("gen", "features", "raceway", "studies")


def packages():
    """Names of all packages of the project."""
    found = list(PACKAGES)
    for name in found:
        path = importlib.import_module(name).__path__
        found += [f"{name}.{module.name}" for module in pkgutil.iter_modules(path) if module.ispkg]
    return found


def test_every_module_imports_only_what_its_contract_allows():
    linter = Path(sys.executable).with_name("lint-imports")
    run = subprocess.run([linter, "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout[run.stdout.find("Contracts") :] + run.stderr
    assert re.search(r"Contracts: [1-9]\d* kept, 0 broken", run.stdout)


@pytest.mark.parametrize("name", packages())
def test_a_package_lists_its_modules_and_no_others_in_its_docstring(name):
    package = importlib.import_module(name)
    modules = {module.name for module in pkgutil.iter_modules(package.__path__) if not module.name.startswith("_")}
    tables = re.findall(r"^=+ =+\n(?:.*\n)*?=+ =+\n((?:.*\n)*?)=+ =+$", package.__doc__ or "", re.MULTILINE)
    listed = {line.split()[0] for table in tables for line in table.splitlines() if line[:1].strip()}
    assert listed == modules


def test_a_file_name_stands_once():
    names = Counter(path.name for package in PACKAGES[:3] for path in (ROOT / package).rglob("*.py"))
    assert [name for name, count in names.items() if count > 1] == ["__init__.py"]
