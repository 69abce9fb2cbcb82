"""The line contact of a roller: two in series, and one against published constants and the elastic half-space.

.. [1] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 7: factor of one line contact of steel.
.. [2] ISO/TS 16281:2008 (DIN 26281), spring constant of a roller between its raceways.
.. [3] K. L. Johnson, *Contact Mechanics*, Cambridge University Press, 1985, sec. 5.6: approach of distant points in plane strain.
"""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import LINE_EXPONENT, line_contact_factor, load_deflection_factor, series_factor

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
