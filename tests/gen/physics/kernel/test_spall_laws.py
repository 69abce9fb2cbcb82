"""Laws of the drop of a ball over a spall."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.extent import TABLE_POINTS
from gen.physics.kernel.drop import GEOMETRIC, PROFILES, RECTANGULAR, TABLE, drop
from gen.physics.kernel.spalls import tabulated
from gen.simulation.damage import cached_drop
from tests.strategies import depths

every_profile = pytest.mark.parametrize("profile", range(TABLE), ids=PROFILES[:TABLE])  # that :func:`drop` knows
BEARING = CATALOGUE["6205"]
BALL = BEARING.ball_diameter / 2
RACES = {"inner": BEARING.inner_radius, "outer": -BEARING.outer_radius}
races = st.sampled_from(sorted(RACES.values()))
halves = st.floats(1e-3, 0.15)
shares = st.floats(0, 1)


def fall(profile, offset, half, race, depth=1.0):
    return drop(profile, offset, half, abs(race), BALL, race, depth)


@every_profile
@given(st.floats(1.0, 100.0), halves, races, depths)
def test_off_the_spall_nothing_drops(profile, beyond, half, race, depth):
    for offset in (beyond * half, -beyond * half):
        assert fall(profile, offset, half, race, depth) == 0.0


@every_profile
@given(shares, halves, races, depths)
def test_a_ball_drops_no_deeper_than_the_spall_and_alike_on_both_sides(profile, share, half, race, depth):
    found = fall(profile, share * half, half, race, depth)
    assert 0.0 <= found <= depth * (1 + 1e-12)
    assert fall(profile, -share * half, half, race, depth) == found


@every_profile
@given(st.floats(-1.2, 1.2), halves, races, depths)
def test_drops_have_no_jump_but_those_of_the_rectangular_profile(profile, share, half, race, depth):
    if profile == RECTANGULAR:
        edge = fall(profile, half * (1 - 1e-9), half, race, depth), fall(profile, half * (1 + 1e-9), half, race, depth)
        assert edge == (depth, 0.0)
        return
    step = 1e-7
    here = fall(profile, share * half, half, race, depth)
    there = fall(profile, (share + step) * half, half, race, depth)
    steepest = max(10 * depth, abs(race) * half)
    assert abs(there - here) < step * steepest


@given(st.floats(-1.2, 1.2), halves, st.integers(0, 2**32 - 1))
def test_a_tabulated_drop_runs_straight_between_its_points_and_is_none_off_the_spall(share, half, seed):
    tables = np.random.default_rng(seed).uniform(0, 1e-4, (2, TABLE_POINTS))
    found = [tabulated.py_func(tables, row, share * half, half) for row in (0, 1)]
    points = np.linspace(-half, half, TABLE_POINTS)
    inside = abs(share * half) < half
    expected = [np.interp(share * half, points, table) if inside else 0.0 for table in tables]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * 1e-4 * TABLE_POINTS)


@every_profile
@given(st.floats(-1, 1), halves, races, depths)
def test_the_drop_in_the_cache_has_the_bits_of_that_in_the_kernel(profile, share, half, race, depth):
    given = profile, share * half, half, abs(race), BALL, race, depth
    assert cached_drop(*given) == drop(*given)


@given(st.floats(1.0, 2.5), st.floats(0, 0.25), races, st.floats(1e-6, 1e-4))
def test_far_inside_a_spall_as_wide_as_several_balls_a_ball_lies_on_the_floor(half, share, race, depth):
    assert fall(GEOMETRIC, share * half, half, race, depth) == depth


@given(shares, halves, races)
def test_a_ball_on_an_edge_keeps_its_distance_from_that_edge(share, half, race):
    """The triangle of ring centre, edge and ball centre, without a sagitta in it."""
    offset = share * half
    angle = half - offset
    reach = abs(race) + math.copysign(BALL, race)
    centre = reach - math.copysign(fall(GEOMETRIC, offset, half, race), race)
    from_edge = math.hypot(centre * math.cos(angle) - abs(race), centre * math.sin(angle))
    assert from_edge == pytest.approx(BALL, rel=1e-9)
