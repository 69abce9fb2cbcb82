"""Laws of the drop of a ball over a spall."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.kernel.drop import GEOMETRIC, PROFILES, TABLE, drop
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
    fallen = fall(profile, share * half, half, race, depth)
    assert 0.0 <= fallen <= depth * (1 + 1e-12)
    assert fall(profile, -share * half, half, race, depth) == fallen


@every_profile
@given(st.floats(-1, 1), halves, races, depths)
def test_the_drop_in_the_cache_has_the_bits_of_that_in_the_kernel(profile, share, half, race, depth):
    arguments = profile, share * half, half, abs(race), BALL, race, depth
    assert cached_drop(*arguments) == drop(*arguments)


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
