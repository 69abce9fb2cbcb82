"""Laws of the hits: how often loaded balls pass the spalls, counted from statics."""

import math

import numpy as np
import pytest

from gen.scenarios import draw_scenarios
from gen.simulation.hits import felt_places, load_zone, loaded_hits
from gen.simulation.inputs import without_fault
from tests.recipes import EVERYTHING
from tests.responses import input_of, label, means_of

LOADED = {"machine.load_angle_deg": -90, "operation.load_n": 300, "operation.mean_slip_percent": 0}


def first_of(recipe_with, fault, **changes):
    recipe = recipe_with(LOADED | {"faults": [fault], "corpus.specimens_per_rig": 1} | changes)
    scenario = draw_scenarios(recipe, 0, 1)[0]
    return scenario, input_of(scenario)


@pytest.mark.parametrize(("clearance", "half"), [(-8, math.pi), (0, math.pi / 2)])
def test_the_load_zone_is_half_the_bearing_without_clearance_and_all_of_it_under_preload(recipe_with, clearance, half):
    _, kernel_input = first_of(recipe_with, {"kind": "healthy"}, **{"specimen.diametral_clearance_um": clearance})
    direction, zone = load_zone(kernel_input)
    assert zone == pytest.approx(half, abs=0.02)
    assert math.remainder(direction + math.pi / 2, 2 * math.pi) == pytest.approx(0.0, abs=0.05)


def test_an_outer_spall_is_hit_at_the_ball_pass_frequency_in_the_load_zone_and_never_outside(recipe_with):
    inside, outside = ({"kind": "outer", "width_mm": 0.5, "angle_deg": angle} for angle in (0, 150))
    scenario, _ = first_of(recipe_with, inside)
    rate, orders = means_of(scenario)
    assert label(scenario, "loaded_hits") == pytest.approx(orders.bpfo * rate * 0.1, abs=0.51)
    scenario, _ = first_of(recipe_with, outside)
    assert label(scenario, "loaded_hits") == 0
    assert felt_places([scenario]) == [False]


def test_an_inner_spall_is_hit_during_the_part_of_a_turn_that_the_load_zone_takes(recipe_with):
    fault = {"kind": "inner", "width_mm": 0.5}
    scenario, kernel_input = first_of(recipe_with, fault, **{"recording.duration_s": 2.0})
    (rate, orders), (_, half) = means_of(scenario), load_zone(kernel_input)
    every = orders.bpfi * rate * 2.0
    assert label(scenario, "loaded_hits") == pytest.approx(every * half / math.pi, abs=1)
    assert 0 < half < math.pi


def test_an_outer_spall_is_hit_if_its_nearer_edge_lies_in_the_load_zone(recipe_with):
    scenario, kernel_input = first_of(recipe_with, {"kind": "outer", "width_mm": 4})
    (_, orders), (direction, half), spall = means_of(scenario), load_zone(kernel_input), kernel_input.spalls[0]
    reach = 0.002 / kernel_input.bearing.outer_radius
    for share, hit in ((0.9, True), (1.1, False)):
        for side in (-1, 1):
            angle = direction + side * (half + share * reach)
            moved = kernel_input._replace(spalls=(spall._replace(angle=angle),))
            assert (loaded_hits(moved, orders, 100) > 0) == hit


def test_a_spall_of_a_ball_is_hit_twice_in_each_turn_of_the_ball(recipe_with):
    fault = {"kind": "ball", "width_mm": 0.5}
    scenario, kernel_input = first_of(recipe_with, fault, **{"recording.duration_s": 2.0})
    (rate, orders), (_, half) = means_of(scenario), load_zone(kernel_input)
    assert label(scenario, "loaded_hits") == pytest.approx(2 * orders.bsf * rate * 2.0 * half / math.pi, abs=1)


def test_a_record_without_its_fault_has_the_input_of_a_sound_record(recipe_with):
    recipe = recipe_with(EVERYTHING)
    for scenario in draw_scenarios(recipe):
        sound = without_fault(input_of(scenario), scenario)
        for field, other in zip(sound, input_of(scenario.without_fault()), strict=True):
            np.testing.assert_equal(field, other)
