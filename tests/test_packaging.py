"""What pyproject.toml and the links of the pages state is true of the project."""

import ast
import re
import sys
import tomllib
from importlib.metadata import packages_distributions, version

from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import Version

from tests.floors import floors
from tests.paths import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
IMPORTED = ("gen", "features", "raceway")
FOLDERS = (*IMPORTED, "recipes", "benchmarks", "docs", "studies", "tests")
FILES = (
    *("pyproject.toml", "MANIFEST.in", "Makefile", "LICENSE", "CITATION.cff"),
    *("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"),
)
LINK = re.compile(r"\]\((?![a-z]+:|#)([^)#]+)")


def test_no_package_is_missing_from_the_list_in_pyproject():
    found = {path.parent.relative_to(ROOT) for name in IMPORTED for path in (ROOT / name).rglob("*.py")}
    assert {".".join(path.parts) for path in found} | {"raceway_recipes"} == set(
        PROJECT["tool"]["setuptools"]["packages"]
    )


def imports(path):
    """Distributions of the packages that a file imports, also inside functions; not the standard library nor Raceway."""
    named = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            named |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            named.add(str(node.module).partition(".")[0])
    return named - sys.stdlib_module_names - {*IMPORTED, "raceway_recipes"}


def test_every_imported_package_is_declared():
    stated = [Requirement(line) for line in all_requirements()]
    declared = {canonicalize_name(name) for one in stated for name in (one.name, *one.extras)}
    named = set().union(*(imports(path) for name in IMPORTED for path in (ROOT / name).rglob("*.py")))
    installed = packages_distributions()
    owners = {name: {canonicalize_name(owner) for owner in installed.get(name, [name])} for name in named}
    assert {name for name, of in owners.items() if not of & declared} == set()


def all_requirements():
    """Requirements of Raceway and of what users can add."""
    optional = PROJECT["project"]["optional-dependencies"]
    return PROJECT["project"]["dependencies"] + [
        line for name in ("parquet", "files", "torch") for line in optional[name]
    ]


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


def test_every_relative_link_of_a_page_leads_to_a_file_of_the_project():
    missing, outside = [], []
    for page in (*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("recipes/*.md")):
        for link in LINK.findall(page.read_text(encoding="utf-8")):
            target = (page.parent / link).resolve()
            if not target.is_relative_to(ROOT) or not target.is_file():
                missing.append((page.name, link))
            elif target.relative_to(ROOT).parts[0] not in (*FILES, *FOLDERS):
                outside.append((page.name, link))
    assert (missing, outside) == ([], [])


def test_lines_of_pages_end_at_120_columns_and_none_is_a_comment():
    """Tables and blocks, which are fenced or indented, may be wider; the site leaves a line out that begins with a percent sign."""
    wide, comments = [], []
    for page in (*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")):
        prose = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        wide += [
            (page.name, line) for line in prose.splitlines() if len(line) > 120 and not line.startswith(("|", "    "))
        ]
        comments += [(page.name, line) for line in prose.splitlines() if line.startswith("%")]
    assert (wide, comments) == ([], [])
