"""Every key of a recipe is listed with a meaning of its own, its unit, range and default."""

import json
import pickle
import re

import pytest

from gen.drawing.distributions import DISTRIBUTIONS
from gen.recipe import find_recipe, read_recipe, recipe_hash, shipped_recipes
from gen.recipe.keys import recipe_keys
from gen.recipe.reading import recipe_schema
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


def test_no_two_keys_of_a_section_have_the_same_meaning():
    found = {}
    for key in KEYS:
        found.setdefault((key.key.rpartition(".")[0], key.kinds, key.meaning), []).append(key.key)
    assert [keys for keys in found.values() if len(keys) > 1] == []


def test_a_key_that_ends_in_a_unit_shows_it():
    ending = {suffix: unit.symbol for suffix, unit in UNITS.items()}
    for key in KEYS:
        name = key.key.rpartition(".")[2]
        wanted = [symbol for suffix, symbol in ending.items() if name == suffix or name.endswith(f"_{suffix}")]
        assert (key.unit in wanted) if wanted else (key.unit == ""), key


def written(value, path=""):
    """Paths of all keys of a recipe file, without list numbers; those of distributions below ``distribution``."""
    if isinstance(value, list):
        return {key for item in value for key in written(item, path)}
    if not isinstance(value, dict):
        return set()
    drawn = {key for found in DISTRIBUTIONS for key in found.model_fields}
    if (
        value.get("kind") in {found.model_fields["kind"].annotation.__args__[0] for found in DISTRIBUTIONS}
        and set(value) <= drawn
    ):
        return {f"distribution.{key}" for key in value}
    below = {key for name, item in value.items() for key in written(item, f"{path}{name}.")}
    return below | {path + name for name in value}


@for_each(shipped_recipes())
def test_every_key_of_a_shipped_recipe_is_listed(name):
    listed = {key.key for key in KEYS}
    used = {
        key
        for key in written(read_yaml(find_recipe(name), RecipeError))
        if not key.startswith("recording.channels.body.")
    }
    # a part has the keys of a fault, and the changes of a fault those of the sections that they change
    places = (
        ("faults.entries", "faults"),
        ("faults.defaults", "faults"),
        ("faults.parts.", "faults."),
        ("faults.level.", "level."),
        ("faults.operation.", "operation."),
    )
    for inside, listed_as in places:
        used = {key.replace(inside, listed_as) for key in used}
    assert used - listed == set()


def test_every_property_of_the_schema_has_a_description():
    schema = json.loads(recipe_schema())
    sections = {"Recipe": schema, **schema["$defs"]}
    silent = [
        f"{name}.{key}"
        for name, section in sections.items()
        for key, found in section.get("properties", {}).items()
        if not found.get("description")
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
