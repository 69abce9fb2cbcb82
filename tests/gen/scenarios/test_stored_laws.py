"""Laws of the stored text of a scenario: it gives the scenario back, names every number, and any other text is refused."""

import json

import pytest

from gen.recipe import Recipe, read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios, read_scenario, scenario_texts
from gen.support.errors import CorpusError
from tests.gen.conftest import small_with
from tests.paths import ROOT
from tests.recipes import EVERYTHING

RECORDS = 48
RECIPES = (*shipped_recipes(), "everything")
MACHINE_KEY = '"machine": {'


def scenarios_of(name):
    if name == "everything":
        return draw_scenarios(Recipe.model_validate(small_with(EVERYTHING)))
    return draw_scenarios(read_recipe(ROOT / "recipes" / f"{name}.yaml"), 0, RECORDS)


def lists_in(value):
    """Every list of a JSON value."""
    if isinstance(value, list):
        yield value
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from lists_in(item)


def kind(item):
    """Names of the values of an item; its type if it is a plain value."""
    return tuple(item) if isinstance(item, dict) else type(item)


@pytest.fixture(scope="module")
def damaged_text():
    """Text of a scenario with a spall on a race."""
    scenarios = scenarios_of("every_fault")
    return next(text for text, one in zip(scenario_texts(scenarios), scenarios, strict=True) if one.specimen.spalls)


@pytest.mark.parametrize("name", RECIPES)
def test_the_text_of_a_scenario_gives_the_scenario_back(name):
    scenarios = scenarios_of(name)
    assert len(scenarios) >= 16
    texts = scenario_texts(scenarios)
    read = [read_scenario(text) for text in texts]
    assert read == scenarios
    assert scenario_texts(read) == texts


@pytest.mark.parametrize("name", RECIPES)
def test_a_text_does_not_depend_on_the_scenarios_written_with_it(name):
    scenarios = scenarios_of(name)
    assert [scenario_texts([scenario])[0] for scenario in scenarios] == scenario_texts(scenarios)


NUMBER_LISTS = {"trace", "times", "shares"}  # series of one quantity


@pytest.mark.parametrize("name", RECIPES)
def test_every_number_of_a_text_has_a_name(name):
    for text in scenario_texts(scenarios_of(name)):
        values = json.loads(text)
        assert list(values) == ["settings", "rig", "specimen", "record"]
        for items in lists_in(values):
            assert not any(isinstance(item, list) for item in items)
            assert len({kind(item) for item in items if item is not None}) <= 1
        numbers = [key for key, items in named_lists(values) if any(isinstance(item, int | float) for item in items)]
        assert set(numbers) <= NUMBER_LISTS


def named_lists(value):
    """Key and list of every list of a JSON object."""
    for key, item in value.items() if isinstance(value, dict) else ():
        if isinstance(item, list):
            yield key, item
        for one in item if isinstance(item, list) else [item]:
            yield from named_lists(one)


NO_SCENARIOS = {
    "empty": "",
    "an empty object": "{}",
    "a list": "[]",
    "null": "null",
    "a number": "1",
    "a string": '"seed"',
    "zero byte": "\0",
    "a lone surrogate": "\ud800",
    "a megabyte of open lists": "[" * 1_000_000,
    "a megabyte of closed lists": "[" * 500_000 + "]" * 500_000,
    "a megabyte of objects": '{"rig":' * 140_000,
}


@pytest.mark.parametrize("text", NO_SCENARIOS.values(), ids=NO_SCENARIOS)
def test_a_text_that_is_no_scenario_is_refused_with_one_sentence(text):
    assert_refused(text)


CHANGES = {
    "cut short": (lambda text: text[:-1], "the whole text"),
    "something after it": (lambda text: text + "{}", "the whole text"),
    "no settings": (lambda text: text.replace('"settings"', '"sowing"'), "settings: Field required"),
    "no seed": (lambda text: text.replace('"seed"', '"sowing"'), "settings.seed: Field required"),
    "a rate of zero": (lambda text: text.replace('"sample_rate": ', '"sample_rate": 0, "x": '), "settings.sample_rate: Input"),
    "a negative number of a rig": (lambda text: text.replace('"rig": {"number": 0', '"rig": {"number": -1'), "rig.number: Input"),
    "a seed of text": (lambda text: text.replace('"seed": ', '"seed": "1", "x": '), "settings.seed: Input should be"),
    "a fraction for a seed": (lambda text: text.replace('"seed": ', '"seed": 0.5, "x": '), "settings.seed: Input should be"),
    "text for a number": (lambda text: text.replace('"depth": ', '"depth": "1e-4", "x": ', 1), "specimen.spalls.0.depth: "),
    "an unknown site": (
        lambda text: text.replace('"site": "', '"site": "roof of the ', 1),
        "specimen.spalls.0.site: Input should be 'inner', 'outer' or 'ball'",
    ),
    "an unknown profile": (lambda text: text.replace('"profile": "', '"profile": "un', 1), "specimen.spalls.0.profile: "),
    "an unknown body": (lambda text: text.replace('"body": "', '"body": "un', 1), "rig.channels.0.body: "),
    "a list for an object": (lambda text: text.replace(MACHINE_KEY, '"machine": [], "x": {'), "rig.machine: "),
    "a key that no scenario has": (lambda text: text.replace('"seed"', '"x": 1, "seed"'), "keys or numbers"),
    "an integer of 5000 digits": (lambda text: text.replace('"seed"', f'"x": {"1" * 5000}, "seed"'), "number out of range"),
    "a deep key that no scenario has": (
        lambda text: text.replace('"seed"', f'"x": {"[" * 100_000 + "]" * 100_000}, "seed"'),
        "recursion limit exceeded",
    ),
    "no number": (lambda text: text.replace(MACHINE_KEY, MACHINE_KEY + '"x": NaN, '), "keys or numbers"),
    "an infinite number": (lambda text: text.replace(MACHINE_KEY, MACHINE_KEY + '"x": 1e999, '), "keys or numbers"),
    "a key of a megabyte": (lambda text: text.replace(MACHINE_KEY, MACHINE_KEY + f'"{"x" * 1_000_000}": "1", '), "rig.machine: "),
    "a key of several lines": (lambda text: text.replace(MACHINE_KEY, MACHINE_KEY + r'"x\ny": "1", '), "rig.machine: "),
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
    assert sentence.endswith(".")
    assert sentence.isprintable()
    assert len(sentence) < 300
    return sentence
