"""The line contact of a roller: two in series, and one against published constants and the elastic half-space.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 7: factor of one line contact of steel.
.. [2] ISO/TS 16281:2008 (DIN 26281), spring constant of a roller between its raceways.
.. [3] K. L. Johnson, *Contact Mechanics*, Cambridge University Press, 1985, sec. 5.6: approach of distant points in plane strain.
"""

import math
from dataclasses import replace
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import LINE_EXPONENT, line_contact_factor, load_deflection_factor, series_factor
from tests.cases import for_each

any_length = st.floats(1e-3, 0.2)
MILLIMETRES = 1e3**LINE_EXPONENT * 1e3 ** (8 / 9)  # N m^-10/9 per m^8/9 in N mm^-10/9 per mm^8/9
lengths = pytest.mark.parametrize("length", [0.005, 0.010, 0.025, 0.050])


@given(any_length, any_length, st.floats(10.0, 1e4))
def test_two_line_contacts_in_series_share_one_force_and_add_their_deflections(inner, outer, force):
    first, second = line_contact_factor(inner), line_contact_factor(outer)
    deflection = (force / first) ** 0.9 + (force / second) ** 0.9
    both = series_factor(first, second, LINE_EXPONENT)
    assert both * deflection**LINE_EXPONENT == pytest.approx(force, rel=1e-12)


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


@for_each(product([1.0, 1.5, 2.0], [5e4, 1e5, 3e5], [0.0075, 0.010, 0.015]))
def test_the_approach_is_that_of_elastic_bodies(case):
    """Palmgren left the diameter out, and how deep a ring deforms is open: half or twice the depth moves the sum by 7 percent.

    Taken for both contacts at once, as some authors do, Palmgren's approach would be half of the theory.
    """
    slenderness, per_length, diameter = case
    modulus, poisson = 207e9, 0.3
    length, depth = slenderness * diameter, diameter
    force = per_length * length
    half_width = math.sqrt(4 * per_length * diameter * (1 - poisson**2) / (math.pi * modulus))  # on a flat
    scale = 2 * per_length * (1 - poisson**2) / (math.pi * modulus)
    roller = scale * (math.log(2 * diameter / half_width) - 0.5)  # half of its compression
    ring = scale * (math.log(2 * depth / half_width) - poisson / (2 * (1 - poisson)))
    assert (force / line_contact_factor(length)) ** 0.9 == pytest.approx(roller + ring, rel=0.15)
