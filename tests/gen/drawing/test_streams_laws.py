"""Law of random numbers by name: a further key, section or mechanism moves no other drawn value of any rig, specimen and record."""

import pytest

from gen.drawing import Distribution, Section, composed, within
from gen.mechanisms.background.background import MACHINE_SOURCES, SOURCES
from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.recipe import Recipe, read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios
from tests.conftest import small_with
from tests.drawn_values import numbers_of
from tests.recipes import EVERYTHING

RECIPES = (*shipped_recipes(), "everything")
EXTENDED = ("machine", "path", "background", "specimen", "operation")
MECHANISMS = {
    "background.harmonics": {"probability": 0.5, "count": "uniform(2, 5)", "level_db": "uniform(-20, 0)"},
    "background.tones": {"probability": 0.5, "count": 2, "frequency_hz": "uniform(50, 400)", "level_db": "uniform(-20, 0)"},
    "background.impulses": {"probability": 0.5, "rate_hz": "uniform(5, 20)", "level_db": 10},
    "background.knocks": {"probability": 0.5, "orders": "uniform(2, 5)", "level_db": 10},
    "background.gear_mesh": {"probability": 0.5, "teeth": "uniform(20, 30)", "mate_teeth": 31, "count": 3, "level_db": "uniform(-20, 0)"},
    "machine_conditions.looseness": {"probability": 0.5, "lift": "uniform(1.1, 2)", "frequency_hz": 800, "level_db": 0},
    "background.bursts": {"probability": 0.5, "level_db": "uniform(-20, 0)"},
    **{f"machine_conditions.{place}": {"probability": 0.5, "count": "uniform(2, 4)", "level_db": "uniform(-20, 0)"}
       for place in ("unbalance", "bent_shaft", "misalignment")},
    "machine_conditions.rub": {"probability": 0.5, "level_db": "uniform(-20, 0)", "noise_db": 0},
    "machine_conditions.belt": {"probability": 0.5, "order": 0.4, "count": "uniform(2, 4)", "level_db": 0},
    "sensor_faults.loose_mount": {"probability": 0.5, "frequency_hz": "uniform(800, 2000)", "damping_percent": 3, "holding_m_s2": 5},
    "sensor_faults.drift": {"probability": 0.5, "settling_m_s2": "uniform(1, 2)"},
    "sensor_faults.mains_hum": {"probability": 0.5, "rms_m_s2": "uniform(1, 2)"},
    "sensor_faults.emi_bursts": {"probability": 0.5, "rate_hz": "uniform(5, 20)", "frequency_hz": 900, "decay_s": 0.01, "peak_m_s2": 10},
    "sensor_faults.gain_steps": {"probability": 0.5, "count": "uniform(1, 3)", "step_db": "uniform(1, 3)"},
    "sensor_faults.saturation": {"probability": 0.5, "limit_m_s2": "uniform(100, 200)"},
    "sensor_faults.dropped_samples": {"probability": 0.5, "count": "uniform(1, 3)", "gap_s": 0.01},
}  # fmt: skip


class Further(Section):
    """A section that no recipe has."""

    count: Distribution = within(1, 4, default="uniform(1, 4)")
    each: Distribution = within(0, 1, default="uniform(0, 1)", each=True)


ADDITIONS = {"key": (Distribution, within(0, 1, default="uniform(0, 1)")), "section": (Further, Further())}


def recipe_of(name):
    """A recipe that draws random numbers: the coordinates of a quasi-random point have an order."""
    recipe = Recipe(small_with(EVERYTHING)) if name == "everything" else read_recipe(name)
    return recipe.model_copy(update={"corpus": recipe.corpus.model_copy(update={"sampling": "random"})})


def extended(section, addition):
    """A section of a recipe with a further key."""
    larger = composed("Larger", __name__, (type(section),), None, further=ADDITIONS[addition])
    return larger.model_validate({key: getattr(section, key) for key in section.model_fields_set})


def added(recipe, larger):
    """Values by which the scenarios of a larger recipe have more than those of a recipe, whose values they have too."""
    found = []
    for one, other in zip(draw_scenarios(recipe, 0, 48), draw_scenarios(larger, 0, 48), strict=True):
        before, after = numbers_of(one), numbers_of(other)
        assert {path: after.get(path) for path in before} == before
        found.append({path: value for path, value in after.items() if path not in before})
    return found


@pytest.mark.parametrize("addition", ADDITIONS)
@pytest.mark.parametrize("name", RECIPES)
def test_a_further_key_or_section_moves_no_other_value(name, addition):
    recipe = recipe_of(name)
    larger = {section: extended(getattr(recipe, section), addition) for section in EXTENDED}
    more = added(recipe, recipe.model_copy(update=larger))
    assert {path.split(".further")[0] for of_record in more for path in of_record} == set(EXTENDED)
    assert len({str(of_record) for of_record in more}) > 1


def test_every_mechanism_is_tried():
    assert {place.rpartition(".")[2] for place in MECHANISMS} == {
        one.place for one in (*SOURCES, *MACHINE_SOURCES, *CHAIN)
    }


@pytest.mark.parametrize("place", MECHANISMS)
def test_a_mechanism_moves_no_other_value(place):
    changes = EVERYTHING | {"corpus": {"rigs": 12, "specimens_per_rig": 2, "records_per_specimen": 2}, "background": {}}
    more = added(*(Recipe(small_with(changes | mechanism)) for mechanism in ({}, {place: MECHANISMS[place]})))
    assert all(path.startswith(place) for of_record in more for path in of_record)
    assert 0 < sum(map(bool, more)) < len(more)
