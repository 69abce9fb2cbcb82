"""Laws of oil, clearance and film."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import contact_exponent, effective_modulus, load_deflection_factor, race_curvatures
from gen.physics.lubricant import (
    STEEL_EXPANSION,
    Lubricant,
    dynamic_viscosity,
    entrainment_speed,
    film,
    kinematic_viscosity,
    line_squeeze_damping,
    lubricated_factor,
    point_film_thickness,
    point_squeeze_damping,
    warm_clearance,
)
from tests.strategies import bearings

ROLLERS = CATALOGUE["NU206"]
temperatures = st.floats(-20, 120)
rates = st.floats(5, 200)
loads = st.floats(10, 3000)
ratios = st.floats(1.1, 4)


@st.composite
def oils(draw):
    """An oil between a light spindle oil and a heavy gear oil."""
    at_100 = draw(st.floats(2e-6, 40e-6))
    at_40 = at_100 * draw(st.floats(2.5, 15))
    return Lubricant(at_40, at_100, draw(st.floats(820, 950)), draw(st.floats(1e-8, 3e-8)))


either = st.one_of(bearings(), st.just(ROLLERS))


@given(oils())
def test_viscosity_passes_through_both_of_its_points(oil):
    assert kinematic_viscosity(oil, 40) == pytest.approx(oil.viscosity_40, rel=1e-10)
    assert kinematic_viscosity(oil, 100) == pytest.approx(oil.viscosity_100, rel=1e-10)
    assert dynamic_viscosity(oil, 15) == pytest.approx(oil.density_15 * kinematic_viscosity(oil, 15), rel=1e-12)


@given(oils(), temperatures, st.floats(0.1, 30))
def test_warmer_oil_is_thinner_and_dynamic_viscosity_falls_faster_than_kinematic(oil, celsius, warmer):
    kinematic = kinematic_viscosity(oil, celsius + warmer) / kinematic_viscosity(oil, celsius)
    assert dynamic_viscosity(oil, celsius + warmer) / dynamic_viscosity(oil, celsius) < kinematic < 1


@given(either, st.floats(-20, 40))
def test_clearance_is_what_the_grown_inner_ring_and_two_grown_balls_leave_free(bearing, hotter):
    bearing = replace(bearing, contact_angle=0.0)
    stack = 2 * (bearing.inner_radius + bearing.ball_diameter) * (1 + STEEL_EXPANSION * hotter)
    free = 2 * bearing.outer_radius - stack
    assert warm_clearance(bearing, 0, hotter) == pytest.approx(free, abs=1e-12 * stack)


@given(bearings(), rates)
def test_both_races_pass_the_cage_at_the_speed_of_entrainment(bearing, rate):
    cage = orders(bearing).ftf
    inner = 2 * math.pi * bearing.inner_radius * rate * (1 - cage)
    outer = 2 * math.pi * bearing.outer_radius * rate * cage
    assert entrainment_speed(bearing, rate) == pytest.approx(inner, rel=1e-12)
    assert entrainment_speed(bearing, rate) == pytest.approx(outer, rel=1e-12)


@given(either, oils(), temperatures, rates, loads, ratios)
def test_the_film_follows_the_powers_of_speed_and_load(bearing, oil, celsius, rate, load, ratio):
    faster, heavier = (0.67, -0.067) if bearing.rolling_element == "ball" else (0.7, -0.13)
    thickness = film(bearing, oil, celsius, rate, load).thickness
    assert film(bearing, oil, celsius, ratio * rate, load).thickness == pytest.approx(ratio**faster * thickness)
    assert film(bearing, oil, celsius, rate, ratio * load).thickness == pytest.approx(ratio**heavier * thickness)


@given(either, oils(), temperatures, st.floats(1, 30), rates, loads)
def test_the_film_thins_with_the_power_of_viscosity_as_its_oil_warms(bearing, oil, celsius, warmer, rate, load):
    cold, warm = film(bearing, oil, celsius, rate, load), film(bearing, oil, celsius + warmer, rate, load)
    thinner = dynamic_viscosity(oil, celsius + warmer) / dynamic_viscosity(oil, celsius)
    power = 0.67 if bearing.rolling_element == "ball" else 0.7
    assert warm.thickness / cold.thickness == pytest.approx(thinner**power)
    assert warm.thickness < cold.thickness


@given(either, oils(), temperatures, rates, loads)
def test_the_stiffness_of_the_film_is_its_load_over_thickness_tangent(bearing, oil, celsius, rate, load):
    step = 1e-4 * load
    below, here, above = (film(bearing, oil, celsius, rate, load + d) for d in (-step, 0, step))
    assert here.stiffness == pytest.approx(2 * step / (below.thickness - above.thickness), rel=1e-6)


@given(oils(), temperatures, rates, loads, ratios)
def test_the_film_of_a_roller_damps_nearly_alike_in_any_oil(oil, celsius, rate, load, ratio):
    """Film thickness grows with the 0.7th power of viscosity, and damping falls with its -1.5th power: the total power is -0.05."""
    thick = oil._replace(density_15=ratio * oil.density_15)
    change = dynamic_viscosity(thick, celsius) / dynamic_viscosity(oil, celsius)
    dampings = [film(ROLLERS, some, celsius, rate, load).damping for some in (oil, thick)]
    assert dampings[1] / dampings[0] == pytest.approx(change**-0.05, rel=1e-9)


@given(bearings(), oils(), temperatures, rates, loads)
def test_both_contacts_in_series_add_their_films_and_damp_less_than_either(bearing, oil, celsius, rate, load):
    modulus, viscosity = (
        effective_modulus(bearing.youngs_modulus, bearing.poisson_ratio),
        dynamic_viscosity(oil, celsius),
    )
    speed = viscosity * entrainment_speed(bearing, rate)
    races = race_curvatures(bearing)
    films = [point_film_thickness(race, modulus, oil.pressure_viscosity, speed, load) for race in races]
    inner, outer = (point_squeeze_damping(race, viscosity, h) for race, h in zip(races, films, strict=True))
    whole = film(bearing, oil, celsius, rate, load)
    assert whole.thickness == pytest.approx(sum(films), rel=1e-12)
    assert whole.damping == pytest.approx(inner * outer / (inner + outer), rel=1e-12)
    assert whole.damping < min(inner, outer)


@given(st.floats(50, 2000), st.floats(1, 50), st.floats(0.05e-6, 3e-6))
def test_the_squeeze_pressure_adds_up_to_the_damping(along, ratio, thickness):
    """Summed over ellipses of one gap each, the one at ``r`` of area ``pi * sqrt(ratio) * r**2``."""

    def pressure(r):
        return 6 / ((1 + 1 / ratio) * (1 + r**2 / 2) ** 2)

    force = 2 * math.pi * math.sqrt(ratio) * quad(lambda r: pressure(r) * r, 0, math.inf)[0]
    damping = point_squeeze_damping((along, along / ratio), 1.0, thickness)
    assert damping == pytest.approx(force / (along**2 * thickness), rel=1e-6)


@given(st.floats(50, 2000), st.floats(1e-3, 0.1), st.floats(0.05e-6, 3e-6))
def test_a_roller_is_damped_by_the_same_pressure_without_curvature_across(curvature, length, thickness):
    per_length = quad(lambda x: 6 / (1 + x**2 / 2) ** 2, -math.inf, math.inf)[0]
    expected = length * per_length * (curvature * thickness) ** -1.5
    assert line_squeeze_damping(curvature, length, 1.0, thickness) == pytest.approx(expected, rel=1e-6)


@given(either, loads, st.floats(1e6, 1e11))
def test_the_lubricated_tangent_is_that_of_contact_and_film_in_series(bearing, load, stiffness):
    factor, exponent = load_deflection_factor(bearing), contact_exponent(bearing)

    def tangent(factor):
        deflection = (load / factor) ** (1 / exponent)
        return exponent * factor * deflection ** (exponent - 1)

    both = tangent(lubricated_factor(factor, exponent, load, stiffness))
    assert both == pytest.approx(1 / (1 / tangent(factor) + 1 / stiffness), rel=1e-10)
    assert both < min(tangent(factor), stiffness)


@pytest.mark.parametrize(("rate", "load"), [(0.0, 100.0), (30.0, 0.0), (-1.0, 100.0)])
def test_a_film_without_speed_or_load_is_refused_with_a_sentence(rate, load):
    with pytest.raises(
        ValueError, match=r"no film forms at shaft_rate = .* Hz and ball_load = .* N; both must be above 0"
    ):
        film(CATALOGUE["6205"], Lubricant(), 60, rate, load)
