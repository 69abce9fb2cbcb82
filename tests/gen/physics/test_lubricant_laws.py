"""Laws of oil, clearance and film."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import contact_exponent, load_deflection_factor
from gen.physics.lubricant import (
    STEEL_EXPANSION,
    Lubricant,
    dynamic_viscosity,
    film,
    kinematic_viscosity,
    line_squeeze_damping,
    lubricated_factor,
    point_squeeze_damping,
    warm_clearance,
)
from tests.strategies import bearings

ROLLERS = CATALOGUE["NU206"]
temperatures = st.floats(-20, 120)
rates = st.floats(5, 200)
loads = st.floats(10, 3000)


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


@given(either, st.floats(-20, 40))
def test_clearance_is_what_the_grown_inner_ring_and_two_grown_balls_leave_free(bearing, hotter):
    bearing = replace(bearing, contact_angle=0.0)
    stack = 2 * (bearing.inner_radius + bearing.ball_diameter) * (1 + STEEL_EXPANSION * hotter)
    free = 2 * bearing.outer_radius - stack
    assert warm_clearance(bearing, 0, hotter) == pytest.approx(free, abs=1e-12 * stack)


@given(either, oils(), temperatures, rates, loads)
def test_the_stiffness_of_the_film_is_its_load_over_thickness_tangent(bearing, oil, celsius, rate, load):
    step = 1e-4 * load
    below, here, above = (film(bearing, oil, celsius, rate, load + d) for d in (-step, 0, step))
    assert here.stiffness == pytest.approx(2 * step / (below.thickness - above.thickness), rel=1e-6)


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
