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
@given(lengths, st.floats(1.1, 5.0))
def test_a_longer_roller_is_stiffer_by_the_power_eight_ninths(length, ratio):
    assert line_contact_factor(ratio * length) == pytest.approx(
        ratio ** (8 / 9) * line_contact_factor(length), rel=1e-12
    )


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


def test_rollers_of_unknown_length_are_refused_with_a_sentence():
    with pytest.raises(
        ValueError, match=r"bearing NU206: the length of its rollers is not known; give roller_length\."
    ):
        load_deflection_factor(replace(ROLLERS, roller_length=None))


def test_a_bearing_of_rollers_deflects_less_than_one_of_balls_of_its_size():
    force = 1000.0
    rollers = (force / load_deflection_factor(ROLLERS)) ** (1 / LINE_EXPONENT)
    balls = (force / load_deflection_factor(CATALOGUE["6206"])) ** (1 / POINT_EXPONENT)
    assert rollers < balls / 2
