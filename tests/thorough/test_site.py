"""The documentation site builds without a warning, so that no link between its pages is dead, and needs no network."""

import re
import subprocess
import sys

import pytest

from tests.paths import ROOT

pytest.importorskip("sphinx")
pytest.importorskip("myst_parser")
pytest.importorskip("pydata_sphinx_theme")
LOADED = re.compile(r"<(?:script|link|img)[^>]*(?:src|href)=\"https?://[^\"]+\.(?:js|css|woff2?|png|svg)")


def test_the_site_builds_without_a_warning_and_loads_nothing_from_elsewhere(tmp_path):
    options = (
        "--quiet",
        "--fail-on-warning",
        "--keep-going",
        "-c",
        "docs/site",
        "-d",
        tmp_path / "trees",
        "-b",
        "html",
    )
    command = [sys.executable, "-m", "sphinx", *map(str, options), ".", str(tmp_path / "site")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    pages = [page.read_text(encoding="utf-8") for page in (tmp_path / "site").rglob("*.html")]
    assert len(pages) > 30
    assert [found for page in pages for found in LOADED.findall(page)] == []
