"""The recipe of one record that docs/labels.md prints is that of its corpus, and gives the record."""

import re
from pathlib import Path

import numpy as np

import gen
from gen.generation.make_part import make_part
from gen.recipe import read_recipe
from gen.scenarios import read_scenarios
from gen.support.errors import RecipeError
from gen.support.yaml_files import parse_yaml

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
