"""Laws of the stored text of a scenario: it gives the scenario back, names every number, and any other text is refused."""

import functools
import re

import pytest

from gen.recipe import Recipe, read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios, read_scenario, scenario_texts
from gen.support.errors import CorpusError
from tests.conftest import small_with
from tests.paths import ROOT
from tests.recipes import EVERYTHING

RECORDS = 24
RECIPES = (*shipped_recipes(), "everything")
MACHINE_KEY = '"machine": {'


@functools.cache
def scenarios_of(name):
    if name == "everything":
        return draw_scenarios(Recipe.model_validate(small_with(EVERYTHING)))
    recipe = read_recipe(ROOT / "recipes" / f"{name}.yaml")
    # a bearing is worn at the end of its life
    whole_life = 0 if recipe.life is None else recipe.corpus.records_per_specimen
    return draw_scenarios(recipe, 0, whole_life or RECORDS)[-RECORDS:]


@pytest.fixture(scope="module")
def damaged_text():
    """Text of a scenario with a spall on a race."""
    scenarios = scenarios_of("every_fault")
    return next(text for text, scenario in zip(scenario_texts(scenarios), scenarios, strict=True) if scenario.spalls)


@pytest.mark.parametrize("name", RECIPES)
def test_the_text_of_a_scenario_gives_the_scenario_back(name):
    scenarios = scenarios_of(name)
    assert len(scenarios) >= 16
    texts = scenario_texts(scenarios)
    read = [read_scenario(text) for text in texts]
    assert read == scenarios
    assert scenario_texts(read) == texts


@pytest.mark.parametrize("name", RECIPES)
def test_a_scenario_as_a_recipe_gives_the_scenario_and_its_text_again(name, tmp_path):
    for scenario in scenarios_of(name)[::12]:
        (tmp_path / "one.yaml").write_text(scenario.text, encoding="utf-8")
        (again,) = draw_scenarios(read_recipe(tmp_path / "one.yaml"))
        assert again == scenario
        assert again.text == scenario.text


CHANGES = {
    "empty": (lambda _: "", "is not the JSON text of a recipe"),
    "a lone surrogate": (lambda _: "\ud800", "is not the JSON text of a recipe"),
    "cut short": (lambda text: text[:-1], "is not the JSON text of a recipe: Expecting"),
    "something after it": (lambda text: text + "{}", "is not the JSON text of a recipe: Extra data"),
    "no origin": (lambda text: text.replace('"origin"', '"orogin"'), "orogin: no such key; did you mean origin?"),
    "a negative number of a rig": (lambda text: text.replace('"rig": 0', '"rig": -1'), "origin.rig: -1 is not allowed here; it must be"),
    "a distribution for a number": (
        lambda text: text.replace('"slope": 0.0', '"slope": "uniform(0, 1)"'), "background.slope: uniform(0, 1) is no number"
    ),
    "a number too few": (lambda text: re.sub(r'"width_mm": .[^]]*.', '"width_mm": []', text, count=1), "width_mm: is a list of 0 numbers"),
    "a fault that does not fit": (lambda text: re.sub(r'"width_mm": .[^]]*.', '"width_mm": [60]', text, count=1), "of 60 mm does not fit"),
    "an integer of 5000 digits": (lambda text: text.replace('"seed"', f'"x": {"1" * 5000}, "seed"'), "value has 5000 digits"),
    "a deep key that no scenario has": (
        lambda text: text.replace('"seed"', f'"x": {"[" * 100_000 + "]" * 100_000}, "seed"'),
        "maximum recursion depth exceeded",
    ),
    "no number": (lambda text: text.replace('"bow_n": 20.0', '"bow_n": NaN'), "machine.bow_n"),
    "a key of a megabyte": (lambda text: text.replace(MACHINE_KEY, MACHINE_KEY + f'"{"x" * 1_000_000}": "1", '), "machine."),
}  # fmt: skip


@pytest.mark.parametrize(("change", "sentence"), CHANGES.values(), ids=CHANGES)
def test_a_changed_scenario_is_refused_by_the_place_of_the_change(damaged_text, change, sentence):
    changed = change(damaged_text)
    assert changed != damaged_text
    assert sentence in assert_refused(changed)


def assert_refused(text):
    """Check that the text is refused with one short sentence, and return it."""
    with pytest.raises(CorpusError) as caught:
        read_scenario(text)
    sentence = str(caught.value)
    assert sentence.startswith("stored scenario: ")
    assert sentence.endswith((".", "?"))
    assert sentence.isprintable()
    assert len(sentence) < 500  # all keys that are allowed, and no more
    return sentence
