"""The documentation site builds without a warning, so that no link is dead, runs its tutorials, and needs no network."""

import pickle
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT

pytest.importorskip("sphinx")
pytest.importorskip("myst_nb")
pytest.importorskip("pydata_sphinx_theme")
LOADED = re.compile(r"<(?:script|link|img)[^>]*(?:src|href)=\"(?:https?:)?//[^\"]+\.(?:m?js|css|woff2?|png|svg)")
MOST_SECONDS = 120


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Folder with the site, built by the command of ``make docs``; a command or cell of a tutorial that fails is an error."""
    folder = tmp_path_factory.mktemp("built")
    options = ["--quiet", "--fail-on-warning", "--keep-going", "-c", "docs/site", "-d", folder / "trees", "-b", "html"]
    command = [sys.executable, "-m", "sphinx", *map(str, options), ".", str(folder / "site")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def test_the_site_loads_nothing_from_elsewhere(built):
    pages = [page.read_text(encoding="utf-8") for page in (built / "site").rglob("*.html")]
    assert len(pages) > 30
    assert [found for page in pages for found in LOADED.findall(page)] == []


def test_each_tutorial_offers_its_notebook(built):
    for tutorial in (ROOT / "docs" / "tutorials").glob("*.md"):
        page = (built / "site" / "docs" / "tutorials" / f"{tutorial.stem}.html").read_text(encoding="utf-8")
        (link,) = re.findall(r'href="([^"]+\.ipynb)"', page)
        assert (built / "site" / "docs" / "tutorials" / link).is_file()


def test_each_tutorial_takes_less_than_two_minutes(built):
    tutorials = pickle.loads((built / "trees" / "environment.pickle").read_bytes()).nb_metadata  # noqa: S301 - our own
    seconds = {
        Path(name).name: facts["exec_data"]["runtime"]
        for name, facts in tutorials.items()
        if name.startswith("docs/tutorials/")
    }
    assert set(seconds) == {path.stem for path in (ROOT / "docs" / "tutorials").glob("*.md")}
    assert max(seconds.values()) < MOST_SECONDS, seconds
