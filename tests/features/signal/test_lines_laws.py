"""Laws of line reading, on levels drawn by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.signal.lines import FAMILIES, Orders, combs, families, fitted_combs, read_lines, single_lines
from features.table.envelope_groups import LINES

ORDERS = Orders(*(np.array([order]) for order in (0.3983, 3.5848, 5.4152, 2.3567)))
BINS_PER_ORDER = 60.0


def level_with(*places, height=2.0, bins=1200):
    level = np.zeros((1, bins))
    level[0, np.rint(places).astype(int)] = height
    return level


def read(level):
    return dict(
        zip((line.name for line in LINES), read_lines(level, np.array([BINS_PER_ORDER]), ORDERS)[0], strict=True)
    )


@given(st.floats(-0.015, 0.015), st.floats(50.0, 390.0))
def test_a_line_within_the_tolerance_is_read_at_its_full_level(error, place):
    assert single_lines(level_with(place * (1 + error)), np.array([[place]]))[0, 0] == 2.0


@given(st.floats(-0.018, 0.018), st.floats(50.0, 390.0))
def test_a_comb_tolerates_a_speed_error_shared_by_its_harmonics(error, base):
    harmonics = np.arange(1, 4) * base * (1 + error)
    wide = level_with(*harmonics, *(harmonics - 1), *(harmonics + 1))
    assert combs(wide, np.array([[base]]))[0, 0] == pytest.approx(2.0)


@given(st.floats(200.0, 390.0))
def test_a_comb_does_not_combine_harmonics_of_different_speeds(base):
    disagreeing = level_with(base * 1.018, 2 * base * 0.982, 3 * base)
    assert combs(disagreeing, np.array([[base]]))[0, 0] == pytest.approx(2.0 / 3)


def test_each_line_is_read_at_its_order():
    ftf, bpfo, bpfi, bsf = (order[0] for order in ORDERS)
    lines = {
        "bpfo_h1": bpfo,
        "bpfi_h1": bpfi,
        "2bsf_h1": 2 * bsf,
        "bpfo_h2": 2 * bpfo,
        "bpfi_h2": 2 * bpfi,
        "2bsf_h2": 4 * bsf,
        "bsf": bsf,
        "fr": 1.0,
        "2fr": 2.0,
        "ftf": ftf,
        "2ftf": 2 * ftf,
        "fr-ftf": 1 - ftf,
    }
    for name, order in lines.items():
        values = read(level_with(order * BINS_PER_ORDER))
        assert values[name] == 2.0, name
        assert values["highest_line"] == 2.0, name


def test_sidebands_are_one_shaft_order_away_and_one_cage_order_for_the_ball():
    ftf, bpfo, bpfi, bsf = (order[0] for order in ORDERS)
    for name, base, side in (("bpfo", bpfo, 1.0), ("bpfi", bpfi, 1.0), ("2bsf", 2 * bsf, ftf)):
        both = read(level_with((base - side) * BINS_PER_ORDER, (base + side) * BINS_PER_ORDER))
        one = read(level_with((base - side) * BINS_PER_ORDER))
        assert both[f"{name}_sidebands"] == 2.0
        assert one[f"{name}_sidebands"] == 1.0


PLACES = families(ORDERS) * BINS_PER_ORDER


def harmonics_of(family, error):
    """Three harmonics of a family at a speed error, three bins wide, so that rounding misses none."""
    middle = np.arange(1, 4) * PLACES[0, family] * (1 + error)
    return np.concatenate([middle - 1, middle, middle + 1])


@given(st.integers(0, 2), st.floats(-0.055, 0.055))
def test_the_combs_at_the_fitted_speed_find_a_family_beside_a_wrong_label(family, error):
    """Beyond 5.5 % BPFI of this bearing is at the place of 2 BSF at another speed, and no comb tells the two apart."""
    found = fitted_combs(level_with(*harmonics_of(family, error)), PLACES)[0]
    assert found[family] == pytest.approx(2.0)
    assert found[-1] == pytest.approx(abs(error), abs=0.01)


@given(st.integers(0, 2), st.sampled_from([-1, 1]))
def test_all_families_are_read_at_one_speed(first, sign):
    """The second family alone would be found: its lines stand at another speed, where no line of the first stands."""
    second = (first + 1) % len(FAMILIES)
    level = level_with(*harmonics_of(first, sign * 0.02)) * 1.5
    level = np.maximum(level, level_with(*harmonics_of(second, -sign * 0.03)))
    found = fitted_combs(level, PLACES)[0]
    assert found[first] == pytest.approx(3.0)
    assert found[second] < 1.5


def test_of_two_speeds_with_equal_combs_the_one_nearer_to_the_label_is_fitted():
    level = np.maximum(level_with(*harmonics_of(1, 0.01)), level_with(*harmonics_of(1, -0.07)))
    assert fitted_combs(level, PLACES)[0, -1] < 0.02


@given(st.integers(0, 2), st.sampled_from([-1, 1]), st.floats(-0.015, 0.015))
def test_families_may_differ_by_the_slip_at_the_fitted_speed(first, sign, error):
    second, fine = (first + 1) % len(FAMILIES), 8 * PLACES  # bins so narrow that rounding is far below the slip
    middle = np.outer(fine[0, [first, second]] * (1 + error + np.array([0, sign * 0.003])), np.arange(1, 4))
    wide = [level_with(*one - 1, *one, *one + 1, bins=9600) for one in middle]
    assert fitted_combs(np.maximum(1.5 * wide[0], wide[1]), fine)[0, second] >= 2.0
