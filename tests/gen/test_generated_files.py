from pathlib import Path

import pytest

from gen.recipe.reading import recipe_schema
from gen.recipe.reference import readme

RECIPES = Path(__file__).parents[2] / "recipes"


@pytest.mark.parametrize(("name", "made"), [("schema.json", recipe_schema), ("README.md", readme)])
def test_a_generated_file_is_what_the_model_says(name, made):
    assert (RECIPES / name).read_text(encoding="utf-8") == made(), f"{name} is out of date: run make generated"
