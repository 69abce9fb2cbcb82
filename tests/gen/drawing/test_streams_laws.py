"""Law of random numbers by name: a further key, section or mechanism moves no other drawn value of any rig, specimen and record."""

import pytest

from gen.drawing import Distribution, Section, composed, within
from gen.mechanisms.background.background import MACHINE_SOURCES, SOURCES
from gen.mechanisms.background.source import BackgroundSource, MachineCondition
from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.mechanisms.chain.sensor_fault import SensorFault
from gen.recipe import Recipe, read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios
from tests.conftest import small_with
from tests.drawn_values import numbers_of
from tests.recipes import EVERYTHING

RECIPES = (*shipped_recipes(), "everything")
EXTENDED = ("machine", "path", "background", "specimen", "operation")


def drawn_keys(mechanism):
    """Keys of a mechanism that half of the items have, each required one drawn from the beginning of its range."""
    keys = {"probability": 0.5}
    for key, field in mechanism.model_fields.items():
        if field.is_required() and (bounds := field.json_schema_extra):
            low, span = bounds["low"], bounds["high"] - bounds["low"]
            keys[key] = f"uniform({low + 1e-4 * span}, {low + 5e-4 * span})"
    return keys


def place_of(mechanism):
    """Path of a mechanism in a recipe."""
    of = {"machine_conditions": MachineCondition, "background": BackgroundSource, "sensor_faults": SensorFault}
    section = next(section for section, base in of.items() if issubclass(mechanism, base))
    return f"{section}.{mechanism.place}"


MECHANISMS = {place_of(mechanism): drawn_keys(mechanism) for mechanism in (*SOURCES, *MACHINE_SOURCES, *CHAIN)}
# keys that are not drawn; the file is read when records are measured
MECHANISMS["background.recording"] |= {"file": "healthy.nc", "sha256": "0" * 64, "stretches": 24}


class Further(Section):
    """A section that no recipe has."""

    count: Distribution = within(1, 4, default="uniform(1, 4)")
    each: Distribution = within(0, 1, default="uniform(0, 1)", each=True)


ADDED = {"further_key": (Distribution, within(0, 1, default="uniform(0, 1)")), "further": (Further, Further())}


def recipe_of(name):
    """A recipe that draws random numbers: the coordinates of a quasi-random point have an order."""
    recipe = Recipe(small_with(EVERYTHING)) if name == "everything" else read_recipe(name)
    return recipe.model_copy(update={"corpus": recipe.corpus.model_copy(update={"sampling": "random"})})


def extended(section):
    """A section of a recipe with a further key and a further section."""
    larger = composed("Larger", __name__, (type(section),), None, **ADDED)
    return larger.model_validate({key: getattr(section, key) for key in section.model_fields_set})


def added(recipe, larger):
    """Values by which the scenarios of a larger recipe have more than those of a recipe, whose values they have too."""
    further = []
    for scenario, other in zip(draw_scenarios(recipe, 0, 48), draw_scenarios(larger, 0, 48), strict=True):
        before, after = numbers_of(scenario), numbers_of(other)
        assert {path: after.get(path) for path in before} == before
        further.append({path: value for path, value in after.items() if path not in before})
    return further


@pytest.mark.parametrize("name", RECIPES)
def test_a_further_key_or_section_moves_no_other_value(name):
    recipe = recipe_of(name)
    larger = {section: extended(getattr(recipe, section)) for section in EXTENDED}
    more = added(recipe, recipe.model_copy(update=larger))
    assert {path.split(".further")[0] for of_record in more for path in of_record} == set(EXTENDED)
    assert len({str(of_record) for of_record in more}) > 1


@pytest.mark.parametrize("place", MECHANISMS)
def test_a_mechanism_moves_no_other_value(place):
    changes = EVERYTHING | {"corpus": {"rigs": 12, "specimens_per_rig": 2, "records_per_specimen": 2}, "background": {}}
    more = added(*(Recipe(small_with(changes | mechanism)) for mechanism in ({}, {place: MECHANISMS[place]})))
    assert all(path.startswith(place) for of_record in more for path in of_record)
    assert 0 < sum(map(bool, more)) < len(more)
