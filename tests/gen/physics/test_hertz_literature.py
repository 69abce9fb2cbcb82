"""Hertz factors against closed forms and an approximation from the literature.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 6.
.. [2] D. E. Brewe, B. J. Hamrock, "Simplified solution for elliptical-contact deformation between two elastic solids", J. Lubr. Technol.
   99 (1977) 485-487.
"""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import contact_factor, effective_modulus, load_deflection_factor, race_factors, series_factor
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
