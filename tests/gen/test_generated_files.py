import re
from pathlib import Path

import numpy as np
import pytest

import gen
from gen import draw_scenarios
from gen.generation.make_part import make_part
from gen.pages import PAGES
from gen.recipe import read_recipe
from gen.scenarios import read_scenarios
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


PAGE = Path(__file__).parents[2] / "docs" / "labels.md"
RECORD = 8


def test_the_printed_recipe_is_that_of_the_record_and_gives_it_again():
    text = re.findall(r"```yaml\n(name: quickstart\n.*?)```", PAGE.read_text(), re.DOTALL)[0]
    recipe = read_recipe("quickstart")
    specimen = recipe.records_of(recipe.specimen_of(RECORD))
    record = make_part(recipe, specimen).isel(record=[RECORD - specimen.start])
    (scenario,) = read_scenarios(record)
    assert scenario.text == text
    again = make_part(gen.read_recipe(parse_yaml(text, "docs/labels.md", RecipeError)), range(1))
    np.testing.assert_array_equal(again["acceleration"], record["acceleration"])
    assert again["width"].item() == record["width"].item() > 0
