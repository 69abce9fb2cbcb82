"""Keys that no shipped recipe sets reach the model, in SI and with the effect that their meaning states."""

import pytest

from gen.scenarios import draw_scenarios
from tests.responses import input_of


def machine_with(recipe_with, changes):
    recipe = recipe_with(changes)
    return input_of(draw_scenarios(recipe, 0, 1)[0]).machine


@pytest.mark.parametrize(
    ("key", "constants"),
    [
        ("ring_stiffness_n_m", ("ring_stiffness_x", "ring_stiffness_y")),
        ("shaft_stiffness_n_m", ("shaft_stiffness",)),
        ("ring_damping_n_s_m", ("ring_damping",)),
        ("shaft_damping_n_s_m", ("shaft_damping",)),
        ("contact_damping_n_s_m", ("contact_damping",)),
    ],
)
def test_a_spring_or_damper_of_the_recipe_is_that_of_the_machine(recipe_with, key, constants):
    machine = machine_with(recipe_with, {f"machine.{key}": 1234.5})
    assert [getattr(machine, constant) for constant in constants] == [1234.5] * len(constants)


def test_the_support_is_stiffer_in_the_vertical_by_its_ratio(recipe_with):
    machine = machine_with(recipe_with, {"machine.support_ratio": 2.5})
    assert machine.support_stiffness_y == pytest.approx(2.5 * machine.support_stiffness_x)


@pytest.mark.parametrize(("key", "low", "high"), [("pressure_viscosity_per_gpa", 10, 30), ("density_kg_m3", 800, 1000)])
def test_an_oil_that_is_more_viscous_under_load_leaves_less_clearance(recipe_with, key, low, high):
    thin, thick = (machine_with(recipe_with, {"contact": {"lubricant": {key: value}}}) for value in (low, high))
    assert thick.half_clearance < thin.half_clearance
