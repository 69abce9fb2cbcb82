"""Every key of a recipe is listed with a meaning of its own, its unit, range and default."""

import json
import pickle
import re

import pytest

from gen.recipe import find_recipe, read_recipe, recipe_hash, shipped_recipes
from gen.recipe.editor_schema import recipe_schema
from gen.recipe.keys import recipe_keys
from gen.support.errors import RecipeError
from gen.support.units import UNITS
from gen.support.yaml_files import read_yaml
from tests.cases import for_each

KEYS = recipe_keys()
SAY_NOTHING = {"a", "an", "the", "of", "in", "and", "or", "per", "to", "is", "for", "value", "number"}


def words(text):
    return {word.removesuffix("s") for word in re.findall(r"[a-z0-9]+", text.lower())} - SAY_NOTHING


@for_each(KEYS, lambda key: "-".join([key.key, *key.kinds]))
def test_a_key_has_a_meaning_that_says_more_than_its_name(key):
    assert key.meaning.endswith("."), f"{key.key} has no sentence"
    unit = set(key.unit.lower().split())
    more = words(key.meaning) - words(key.key.rpartition(".")[2].replace("_", " ")) - unit
    assert len(more) >= 2, f"{key.key}: {key.meaning!r} says no more than the key"


def test_a_key_that_ends_in_a_unit_shows_it():
    ending = {suffix: unit.symbol for suffix, unit in UNITS.items()}
    for key in KEYS:
        name = key.key.rpartition(".")[2]
        wanted = [symbol for suffix, symbol in ending.items() if name == suffix or name.endswith(f"_{suffix}")]
        assert (key.unit in wanted) if wanted else (key.unit == ""), key


def names_in(value):
    """Names of all keys in a value of a recipe file."""
    below = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return set().union(value if isinstance(value, dict) else (), *map(names_in, below))


def test_every_key_of_a_shipped_recipe_is_listed():
    used = names_in([read_yaml(find_recipe(name), RecipeError) for name in shipped_recipes()])
    bodies, of_faults = {"sensor", "housing", "ring", "shaft"}, {"defaults", "entries"}
    assert used - {name for key in KEYS for name in key.key.split(".")} - bodies - of_faults == set()


def test_every_property_of_the_schema_has_a_description():
    schema = json.loads(recipe_schema())
    sections = {"Recipe": schema, **schema["$defs"]}
    silent = [
        f"{name}.{key}"
        for name, section in sections.items()
        for key, described in section.get("properties", {}).items()
        if not described.get("description")
    ]
    assert silent == []


def test_an_unknown_prefix_is_refused_with_the_words_that_keys_begin_with():
    with pytest.raises(
        RecipeError, match=r"^mashine: no key of a recipe begins like this; .* name, title, .*distribution\.$"
    ):
        recipe_keys("mashine")


@pytest.mark.parametrize("name", shipped_recipes())
def test_a_recipe_is_the_same_in_another_process(name):
    recipe = read_recipe(name)
    sent = pickle.loads(pickle.dumps(recipe))  # noqa: S301 - just made
    assert sent == recipe
    assert recipe_hash(sent) == recipe_hash(recipe)
