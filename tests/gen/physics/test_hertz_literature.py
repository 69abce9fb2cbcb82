"""Hertz factors, contact ellipses and line contacts against closed forms, published constants and a model study.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 6, and ch. 7 for the factor of one line contact of steel.
.. [2] D. E. Brewe, B. J. Hamrock, "Simplified solution for elliptical-contact deformation between two elastic solids", J. Lubr. Technol.
   99 (1977) 485-487.
.. [3] ISO/TS 16281:2008 (DIN 26281), spring constant of a roller between its raceways.
"""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import (
    LINE_EXPONENT,
    contact_factor,
    effective_modulus,
    ellipticity,
    footprints,
    line_contact_factor,
    load_deflection_factor,
    race_curvatures,
    race_factors,
    series_factor,
)
from tests.paths import GOLDEN
from tests.strategies import bearings

STEEL = effective_modulus(207e9, 0.3)
FACTORS = json.loads((GOLDEN / "model.json").read_text())["load_deflection_factors"]


@given(st.floats(1e-4, 1.0))
def test_a_sphere_on_a_flat_of_the_same_metal_has_the_closed_form_of_hertz(radius):
    combined = STEEL / 2  # both bodies give, each as much
    expected = 4 / 3 * combined * math.sqrt(radius)
    assert contact_factor(1 / radius, 1 / radius, STEEL) == pytest.approx(expected, rel=1e-6)


@given(st.floats(3.0, 45.0), st.floats(1e-3, 1e-1))
def test_a_contact_as_in_ball_bearings_is_within_three_percent_of_brewe_and_hamrock(ratio, radius):
    """Ratios of curvature in the catalogue lie between 14 and 45; nearer to the sphere their three fits add up to 8 percent."""
    factor = contact_factor(1 / radius, 1 / radius / ratio, STEEL)
    k = 1.0339 * ratio**0.6360
    second, first = 1.0003 + 0.5968 / ratio, 1.5277 + 0.6023 * math.log(ratio)
    mean = 1 / (1 / radius + 1 / radius / ratio)
    assert factor == pytest.approx(math.pi * k * STEEL * math.sqrt(mean * second / (4.5 * first**3)), rel=0.03)


@pytest.mark.parametrize("row", FACTORS, ids=lambda row: f"{row['bearing']}-{row['inner_conformity']}")
def test_the_factors_of_catalogue_bearings_are_those_of_the_model_study(row):
    bearing = replace(
        CATALOGUE[row["bearing"]], inner_conformity=row["inner_conformity"], outer_conformity=row["outer_conformity"]
    )
    digits = 1e-4  # five figures are given
    assert race_factors(bearing) == pytest.approx((row["inner"], row["outer"]), rel=digits)
    assert load_deflection_factor(bearing) == pytest.approx(row["both"], rel=digits)


@given(bearings())
def test_two_contacts_in_series_share_one_force_and_add_their_deflections(bearing):
    inner, outer = race_factors(bearing)
    force = 100.0
    deflection = (force / inner) ** (2 / 3) + (force / outer) ** (2 / 3)
    assert series_factor(inner, outer) * deflection**1.5 == pytest.approx(force, rel=1e-12)
    assert load_deflection_factor(bearing) < min(inner, outer)


LOAD = 200.0  # of one ball of a 6205 [N]
# half the length and half the width of the ellipse [m], largest pressure [Pa], approach [m]; model study, three figures at most
STUDY = {"inner": (0.77e-3, 0.083e-3, 1.50e9, 3.95e-6), "outer": (0.75e-3, 0.103e-3, 1.25e9, 3.80e-6)}


@pytest.mark.parametrize("race", [0, 1], ids=STUDY)
def test_the_ellipse_of_a_6205_is_that_of_the_model_study(race):
    bearing = CATALOGUE["6205"]
    long, short, pressure, approach = list(STUDY.values())[race]
    width = footprints(bearing, LOAD)[race]
    length = width * ellipticity(*race_curvatures(bearing)[race])
    assert width == pytest.approx(short, abs=0.51e-6)  # the last figure given; 82.5 um was rounded up
    assert length == pytest.approx(long, abs=0.5e-5)
    assert 1.5 * LOAD / (math.pi * length * width) == pytest.approx(pressure, abs=0.5e7)
    assert (LOAD / race_factors(bearing)[race]) ** (2 / 3) == pytest.approx(approach, abs=0.5e-8)


def test_the_contact_of_a_roller_is_the_strip_of_two_cylinders():
    bearing = CATALOGUE["NU206"]
    assert bearing.roller_length is not None
    for width, radius in zip(footprints(bearing, LOAD), (bearing.inner_radius, -bearing.outer_radius), strict=True):
        together = 1 / (2 / bearing.ball_diameter + 1 / radius)
        strip = math.sqrt(4 * LOAD * together / (math.pi * bearing.roller_length * STEEL / 2))
        assert width == pytest.approx(strip, rel=1e-12)


any_length = st.floats(1e-3, 0.2)
MILLIMETRES = 1e3**LINE_EXPONENT * 1e3 ** (8 / 9)  # N m^-10/9 per m^8/9 in N mm^-10/9 per mm^8/9
lengths = pytest.mark.parametrize("length", [0.005, 0.010, 0.025, 0.050])


@given(any_length)
def test_a_roller_bearing_has_both_contacts_of_one_roller_in_series(length):
    bearing = replace(CATALOGUE["NU206"], roller_length=length)
    assert load_deflection_factor(bearing) == pytest.approx(2**-LINE_EXPONENT * line_contact_factor(length), rel=1e-12)


@lengths
def test_one_contact_has_the_factor_of_harris(length):
    assert line_contact_factor(length) == pytest.approx(8.06e4 * length ** (8 / 9) * MILLIMETRES, rel=1e-3)


@lengths
def test_a_roller_between_its_raceways_has_the_spring_constant_of_the_standard(length):
    """Both are fits to measurements; read as both contacts at once, Palmgren's would be stiffer by a factor of 2.2."""
    contact = line_contact_factor(length)
    both = series_factor(contact, contact, LINE_EXPONENT)
    assert both == pytest.approx(35948 * length ** (8 / 9) * MILLIMETRES, rel=0.05)
