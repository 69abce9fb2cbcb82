"""Laws of the speed that fits lines: which evidence is clear, and what changes nothing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.signal.lines import FAMILIES
from features.signal.speed import (
    COMBS,
    EVIDENCE,
    FLOOR,
    SHAFT_HARMONICS,
    SHAFT_SHIFT,
    SLIP,
    candidates,
    find_speed,
    levels_at,
    near_label,
)

HARMONICS = 3  # of each comb
COMB_LINES = len(COMBS) * HARMONICS
LINES = COMB_LINES + 2 * SHAFT_HARMONICS
CANDIDATES = len(candidates()) + 2 * SHAFT_SHIFT
errors = st.integers(-75, 75)  # candidates beside the label


def levels_with(comb=None, shaft=None, height=2.0):
    """Levels of noise with lines at candidates beside the label: of family ``comb[0]`` at ``comb[1]``, of the shaft."""
    levels = np.full((LINES, CANDIDATES), FLOOR)
    middle = CANDIDATES // 2
    if comb is not None:
        family, place = comb
        levels[family * HARMONICS : (family + 1) * HARMONICS, middle + place] = height
    if shaft is not None:
        levels[COMB_LINES:, middle + shaft] = height
    return levels


@given(st.floats(1.0, 8.0), st.floats(-0.07, 0.07), st.floats(10.0, 40.0))
def test_the_level_of_a_line_is_read_at_the_candidate_that_hits_it(order, error, bins_per_order):
    place = order * bins_per_order * (1 + error)
    level = np.maximum(0.0, 1.0 - np.abs(np.arange(400) - place) / 3)[None].astype(np.float32)
    read = levels_at(level, np.array([[order * bins_per_order]]), near_label())[0, 0]
    found = candidates(0.08 + SHAFT_SHIFT * 0.001)[read.argmax()]
    assert abs(found - error) * order * bins_per_order <= 1.0  # a bin


@given(st.integers(0, len(FAMILIES) - 1), errors, st.integers(-SHAFT_SHIFT, SHAFT_SHIFT), st.floats(8.0, 50.0))
def test_a_comb_and_a_shaft_within_the_slip_of_each_other_are_clear_evidence(family, place, slip, label):
    found = find_speed(levels_with((family, place), place + slip), 10, label)
    assert found.clear
    assert found.evidence == FAMILIES[family]
    assert found.rate == pytest.approx(label * (1 + place * 0.001))
    assert SLIP * label <= found.uncertainty < 0.015 * label
    assert found.agrees == (abs(found.rate - label) <= 2 * found.uncertainty)


@given(errors)
def test_the_shaft_alone_is_named_where_no_comb_is(place):
    found = find_speed(levels_with(shaft=place), 10, 25.0)
    assert not found.clear or found.evidence == "shaft"
    assert abs(found.rate / 25.0 - 1 - place * 0.001) <= SHAFT_SHIFT * 0.001 + 1e-9


@given(st.integers(0, 2), errors, st.sampled_from([-60, -40, 40, 60]))
def test_a_comb_that_contradicts_the_shaft_is_not_clear(family, place, apart):
    other = place + apart
    if abs(other) <= 75:  # a bearing other than the one that is named gives such a comb
        assert not find_speed(levels_with((family, place), other), 10, 25.0).clear


@given(st.integers(0, 1), st.integers(-75, -10), st.integers(1, 2))
def test_two_families_that_fit_two_speeds_equally_are_not_clear(family, place, step):
    levels = np.maximum(levels_with((family, place)), levels_with(((family + step) % 3, place + 60)))
    found = find_speed(levels, 10, 25.0)
    assert not found.clear
    assert found.agrees
    assert found.evidence == EVIDENCE[0]


def test_without_a_window_nothing_is_known():
    found = find_speed(np.zeros((1, 1)), 0, 25.0)
    assert np.isnan(found.rate)
    assert not found.clear
    assert found.agrees
