import re

import pytest

from gen import draw_scenarios, read_recipe
from gen.pages import PAGES
from gen.support.errors import RecipeError
from gen.support.yaml_files import parse_yaml
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


def test_the_first_recipe_of_the_page_makes_records_of_all_its_widths():
    (text,) = re.findall(r"```yaml\n(.*?)```", (ROOT / "recipes/README.md").read_text(encoding="utf-8"), re.DOTALL)
    scenarios = draw_scenarios(read_recipe(parse_yaml(text, "recipes/README.md", RecipeError)))
    widths = {round(1e3 * spall.width, 6) for scenario in scenarios for spall in scenario.spalls}
    assert widths == {0.2, 0.4, 0.6, 0.8, 1.0}
    assert {scenario.bearing.n_balls for scenario in scenarios} == {22}
