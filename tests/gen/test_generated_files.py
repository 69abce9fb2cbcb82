import re

import pytest

from gen.pages import PAGES
from tests.paths import ROOT


@pytest.mark.parametrize("name", PAGES)
def test_a_generated_file_is_what_the_code_says(name):
    assert (ROOT / name).read_text(encoding="utf-8") == PAGES[name](), f"{name} is out of date: run make generated"


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=lambda path: path.name)
def test_every_file_that_a_page_names_is_there(page):
    text = page.read_text(encoding="utf-8")
    named = re.findall(r"`((?:gen|features|raceway|tests|benchmarks|docs|recipes)/[\w/.]+\.\w+)`", text)
    linked = [target for target in re.findall(r"\]\(([\w./-]+)\)", text) if not target.startswith("http")]
    assert [name for name in named if "NAME" not in name and not (ROOT / name).exists()] == []
    assert [target for target in linked if not (page.parent / target).exists()] == []
