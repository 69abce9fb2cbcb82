"""Laws of the line contact of a roller."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import (
    LINE_EXPONENT,
    POINT_EXPONENT,
    contact_exponent,
    line_contact_factor,
    load_deflection_factor,
    series_factor,
)

law = settings(deadline=None, max_examples=100)
lengths = st.floats(1e-3, 0.2)
ROLLERS = CATALOGUE["NU206"]


@law
@given(lengths, lengths, st.floats(10.0, 1e4))
def test_two_line_contacts_in_series_share_one_force_and_add_their_deflections(inner, outer, force):
    first, second = line_contact_factor(inner), line_contact_factor(outer)
    deflection = (force / first) ** 0.9 + (force / second) ** 0.9
    both = series_factor(first, second, LINE_EXPONENT)
    assert both * deflection**LINE_EXPONENT == pytest.approx(force, rel=1e-12)


@law
@given(lengths)
def test_a_roller_bearing_has_both_contacts_of_one_roller_in_series(length):
    bearing = replace(ROLLERS, roller_length=length)
    assert load_deflection_factor(bearing) == pytest.approx(2**-LINE_EXPONENT * line_contact_factor(length), rel=1e-12)


def test_the_exponent_follows_the_rolling_element():
    assert contact_exponent(ROLLERS) == LINE_EXPONENT
    assert contact_exponent(CATALOGUE["6205"]) == POINT_EXPONENT
