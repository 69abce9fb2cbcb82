"""Laws of shares: a quantity that is a share of another is that share of its value, and no other quantity moves."""

import math
from contextlib import nullcontext

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen import uniform
from gen.physics.bearing import ball_spacing
from gen.physics.catalogue import CATALOGUE
from gen.recipe import ranges
from gen.scenarios import draw_scenarios
from gen.simulation.surroundings import machine_of
from tests.drawn_values import anywhere, with_key_of

SAMPLINGS = ("random", "sobol", "halton")
SLANTED = {"specimen.contact_angle_deg": 10}


def share(of, low, high):
    return uniform(low, high) * of


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_an_axial_load_is_its_share_of_the_radial_load_of_the_same_record(recipe_with, sampling):
    axial = {"operation.axial_load_n": share("load_n", 0.1, 0.6), "corpus.sampling": sampling}
    numbers = {"operation.axial_load_n": uniform(0.1, 0.6), "corpus.sampling": sampling}
    drawn, own = (draw_scenarios(recipe_with(SLANTED | changes)) for changes in (axial, numbers))
    for scenario, other in zip(drawn, own, strict=True):
        expected = other.conditions["axial_load"] * scenario.conditions["load"]
        assert scenario.conditions["axial_load"] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("key", "named"),
    [
        ("load_n", "bow_n"),
        ("shaft_rpm", "support_frequency_hz"),
        ("slip_percent", "mean_slip_percent"),
        ("axial_load_n", "load_n"),
    ],
)
def test_to_make_a_quantity_a_share_moves_no_other(recipe_with, key, named):
    profile = {"kind": "ramp", "from_percent": uniform(50, 60), "to_percent": 99}
    usual = SLANTED | {"machine.bow_n": 1000.0, "operation.speed_profile": profile}
    without = draw_scenarios(recipe_with(usual))
    drawn = draw_scenarios(recipe_with(usual | {f"operation.{key}": share(named, 0.05, 0.06)}))
    for scenario, other in zip(drawn, without, strict=True):
        assert getattr(scenario.recipe.operation, key) != getattr(other.recipe.operation, key)
        # the balance grade holds at the highest speed of the recipe
        balanced = scenario.recipe.machine.model_copy(update={"balance_rpm": other.recipe.machine.balance_rpm})
        assert with_key_of(scenario.edited(machine=balanced), other, "operation", key) == anywhere(other)


def test_a_share_can_name_quantities_of_every_level_above(recipe_with):
    recipe = recipe_with(
        SLANTED
        | {
            "machine.bow_n": uniform(10, 20),
            "machine.misalignment_n": share("bow_n", 0.5, 0.5),
            "machine.resonator.mass_kg": share("shaft_mass_kg", 0.02, 0.02),
            "specimen.waviness_nm": share("ball_diameter_mm", 1e-6, 1e-6),
            "specimen.ball_waviness_nm": share("waviness_nm", 0.25, 0.25),
            "operation.load_n": share("bow_n", 8, 8),
            "operation.jitter_deg": share("contact_angle_deg", 0.1, 0.1),
            "contact": {"lubricant": {"viscosity_100_mm2_s": share("viscosity_40_mm2_s", 0.125, 0.125)}},
        }
    )
    for scenario in draw_scenarios(recipe):
        machine, properties, conditions = scenario.machine, scenario.properties, scenario.conditions
        assert machine["misalignment"] == pytest.approx(machine["bow"] / 2)
        assert scenario.recipe.machine.resonator.si()["mass"] == pytest.approx(machine["shaft_mass"] / 50)
        assert properties["waviness"] == pytest.approx(1e-6 * CATALOGUE["6205"].ball_diameter)
        assert properties["ball_waviness"] == pytest.approx(properties["waviness"] / 4)
        assert conditions["load"] == pytest.approx(8 * machine["bow"])
        assert conditions["jitter"] == pytest.approx(math.radians(1))
        assert scenario.recipe.contact.lubricant.si()["viscosity_100"] == pytest.approx(68e-6 / 8)


def test_a_chain_of_shares_is_a_product_in_any_order(recipe_with):
    chain = {"operation.load_n": share("axial_load_n", 4, 4), "operation.axial_load_n": share("bow_n", 2, 2)}
    recipe = recipe_with(SLANTED | chain | {"machine.bow_n": uniform(10, 20)})
    for scenario in draw_scenarios(recipe):
        assert scenario.conditions["axial_load"] == pytest.approx(2 * scenario.machine["bow"])
        assert scenario.conditions["load"] == pytest.approx(8 * scenario.machine["bow"])
    assert ranges(recipe)["operation"]["load_n"] == pytest.approx((80, 160))


def test_the_contact_angle_of_a_specimen_is_that_of_its_clearance_and_grooves(recipe_with):
    """By the formula of Harris, written out."""
    recipe = recipe_with(
        {
            "specimen.contact_angle_deg": share("free_contact_angle_deg", 1, 1),
            "specimen.inner_conformity": uniform(0.515, 0.53),
            "specimen.outer_conformity": share("inner_conformity", 1.01, 1.01),
        }
    )
    angles = set()
    for scenario in draw_scenarios(recipe):
        drawn = scenario.properties
        apart = (2.01 * drawn["inner_conformity"] - 1) * CATALOGUE["6205"].ball_diameter
        expected = math.acos(1 - max(drawn["diametral_clearance"], 0) / 2 / apart)
        assert drawn["contact_angle"] == pytest.approx(expected, rel=1e-6, abs=1e-9)
        assert scenario.bearing.contact_angle == drawn["contact_angle"]
        angles.add(drawn["contact_angle"])
    assert 0.0 in angles  # some specimens have no clearance
    assert max(angles) > math.radians(5)


@pytest.mark.parametrize("site", ["inner", "outer"])
def test_a_spall_can_be_a_share_of_the_arc_between_two_balls(recipe_with, site):
    entry = {
        "kind": site,
        "width_mm": share("ball_spacing_mm", 0.1, 0.3),
        "depth_um": share("width_mm", 0.01, 0.01),
        "n_spalls": 3,
    }
    spalls = [
        (scenario, spall) for scenario in draw_scenarios(recipe_with({"faults": [entry]})) for spall in scenario.spalls
    ]
    shares = [spall.width / ball_spacing(scenario.bearing, site) for scenario, spall in spalls]
    assert 0.1 <= min(shares) < 0.15 < 0.25 < max(shares) <= 0.3
    assert [spall.depth for _, spall in spalls] == pytest.approx([0.01 * spall.width for _, spall in spalls])


@pytest.mark.parametrize("of_drawing", [0, 25])
def test_a_share_above_1_of_the_least_axial_load_holds_the_rings_together(recipe_with, of_drawing):
    """1.25 tan(contact angle) of the radial load, at any contact angle; just below it the machine is not possible."""
    bearing = {"kind": "geometry", "n_balls": 9, "pitch_diameter_mm": 39, "ball_diameter_mm": 7.8}
    changes = {
        "bearing": bearing | {"contact_angle_deg": of_drawing},
        "specimen.contact_angle_deg": uniform(5, 15),
        "operation.load_n": uniform(10, 1000),
    }
    for times, possible in ((1.001, True), (0.999, False)):
        recipe = recipe_with(changes | {"operation.axial_load_n": share("least_axial_load_n", times, times)})
        for scenario in draw_scenarios(recipe, 0, 6):
            conditions, angle = scenario.conditions, scenario.bearing.contact_angle
            assert conditions["axial_load"] == pytest.approx(times * 1.25 * math.tan(angle) * conditions["load"])
            with nullcontext() if possible else pytest.raises(ValueError, match="too small to hold its rings together"):
                machine_of(scenario)


@given(st.tuples(*[st.floats(0.01, 2)] * 2), st.tuples(*[st.floats(10, 1000)] * 2), st.integers(0, 2**31))
def test_every_product_lies_in_its_support(recipe_with, shares, loads, seed):
    axial, load = share("load_n", *sorted(shares)), uniform(*sorted(loads))
    recipe = recipe_with(SLANTED | {"seed": seed, "operation.load_n": load, "operation.axial_load_n": axial})
    low, high = ranges(recipe)["operation"]["axial_load_n"]
    assert (low, high) == pytest.approx((min(shares) * min(loads), max(shares) * max(loads)))
    for scenario in draw_scenarios(recipe, 0, 4):
        assert low * (1 - 1e-9) <= scenario.conditions["axial_load"] <= high * (1 + 1e-9)


def test_the_unbalance_follows_the_highest_product_of_a_speed_that_is_a_share(recipe_with):
    rated = {"machine.support_frequency_hz": uniform(200, 500), "machine.balance_mm_s": 1}
    share_of_it, plain = share("support_frequency_hz", 0.02, 0.1), uniform(240, 3000)
    scenario, other = (
        draw_scenarios(recipe_with(rated | {"operation.shaft_rpm": speed}), 0, 1)[0] for speed in (share_of_it, plain)
    )
    assert scenario.recipe.machine.unbalance == pytest.approx(other.recipe.machine.unbalance)


def test_balls_of_a_range_leave_room_for_a_cage_and_fixed_ones_stay(recipe_with):
    fixed = {"kind": "geometry", "n_balls": 22, "pitch_diameter_mm": 60, "ball_diameter_mm": 7.5}
    drawn = [
        draw_scenarios(recipe_with({"bearing": bearing}), 0, 1)[0].bearing.ball_diameter
        for bearing in (fixed, fixed | {"ball_diameter_mm": uniform(7.5, 7.6)})
    ]
    assert drawn == pytest.approx([7.5e-3, 0.85 * math.pi * 60e-3 / 22])
