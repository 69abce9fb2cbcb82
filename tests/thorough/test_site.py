"""The documentation site builds without a warning, so that no link is dead, runs its tutorials, and needs no network."""

import re
import subprocess
import sys

import pytest

from tests.paths import ROOT

pytest.importorskip("sphinx")
pytest.importorskip("myst_nb")
pytest.importorskip("pydata_sphinx_theme")
LOADED = re.compile(r"<(?:script|link|img)[^>]*(?:src|href)=\"(?:https?:)?//[^\"]+\.(?:m?js|css|woff2?|png|svg)")
TIMED = re.compile(r"docs/tutorials/([\w-]+)</span></a></p></td>.*?<td><p>([\d.]+)</p></td>", re.DOTALL)
MOST_SECONDS = 120


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder of the site, built by the command of ``make docs``; a command or cell of a tutorial that fails is an error."""
    folder = tmp_path_factory.mktemp("site")
    options = ["--quiet", "--fail-on-warning", "--keep-going", "-c", "docs/site", "-d", folder / "trees", "-b", "html"]
    command = [sys.executable, "-m", "sphinx", *map(str, options), ".", str(folder / "site")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "site"


def test_the_site_loads_nothing_from_elsewhere(site):
    pages = [page.read_text(encoding="utf-8") for page in site.rglob("*.html")]
    assert len(pages) > 30
    assert [found for page in pages for found in LOADED.findall(page)] == []


def test_each_tutorial_takes_less_than_two_minutes(site):
    page = (site / "docs" / "site" / "tutorials.html").read_text(encoding="utf-8")
    seconds = {name: float(taken) for name, taken in TIMED.findall(page)}
    assert set(seconds) == {path.stem for path in (ROOT / "docs" / "tutorials").glob("*.md")}
    assert max(seconds.values()) < MOST_SECONDS, seconds
