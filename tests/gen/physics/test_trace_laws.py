"""Laws of the path over a measured surface, and of its mean over a contact of finite width."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.extent import TABLE_POINTS
from gen.physics.kernel.drop import GEOMETRIC, drop, sagitta
from gen.physics.trace import ball_path, contact_mean, rough_surface, spall_positions

BEARING = CATALOGUE["6205"]
BALL = BEARING.ball_diameter / 2
RACES = {"inner": BEARING.inner_radius, "outer": -BEARING.outer_radius}
races = st.sampled_from(sorted(RACES.values()))
widths = st.floats(0.15e-3, 2e-3)
depths = st.floats(1e-6, 3e-4)
surfaces = st.lists(st.floats(0, 1e-4), min_size=3, max_size=40)


@given(st.floats(0.15e-3, 1e-3), depths, races)
def test_over_sound_edges_and_a_flat_floor_a_ball_follows_the_geometric_path(width, depth, race):
    """A spall this narrow is as good as flat: chord and arc differ by 2e-4, and the sagitta by twice that."""
    arc = abs(race)
    expected = [drop(GEOMETRIC, x / arc, width / 2 / arc, arc, BALL, race, depth) for x in spall_positions(width)]
    path = ball_path(np.full(9, depth), width, BALL, race)
    np.testing.assert_allclose(path, expected, rtol=1e-3, atol=1e-15)


@given(surfaces, st.floats(0.15e-3, 12e-3), races)
def test_a_ball_goes_no_deeper_than_the_surface_under_it_and_never_above_a_sound_one(surface, width, race):
    path = ball_path(np.array(surface), width, BALL, race)
    under = np.interp(np.linspace(0, 1, TABLE_POINTS), np.linspace(0, 1, len(surface)), surface)
    assert path.shape == (TABLE_POINTS,)
    assert path[0] == path[-1] == 0
    assert (path >= 0).all()
    assert (path <= under + 1e-18).all()


@given(st.integers(3, 40), races)
def test_a_wide_ball_bridges_a_narrow_scratch(half, race):
    """Between its lips the path is that over a spall as wide as the scratch, however deep it is."""
    width, middle = 2e-3, TABLE_POINTS // 2
    surface = np.zeros(TABLE_POINTS)
    surface[middle - half + 1 : middle + half] = 1e-4
    lip = half * width / (TABLE_POINTS - 1)
    path = ball_path(surface, width, BALL, race)
    assert path.max() == pytest.approx(float(sagitta(lip, BALL) + sagitta(lip, race)), rel=1e-6)
    assert path.max() < 1e-5
    assert not path[np.abs(spall_positions(width)) >= lip].any()


def test_under_a_contact_the_pressure_weighs_as_half_an_ellipse():
    """Over a step the contact feels the share of its load that has crossed it: 1/2 + (u sqrt(1 - u^2) + asin u) / pi."""
    width, footprint = 2e-3, 1e-4
    at = spall_positions(width + 2 * footprint)
    mean = contact_mean(np.ones(TABLE_POINTS), width, footprint, footprint)
    across = np.abs(at + width / 2) < 0.9 * footprint
    u = (at[across] + width / 2) / footprint
    np.testing.assert_allclose(mean[across], 0.5 + (u * np.sqrt(1 - u**2) + np.arcsin(u)) / math.pi, atol=0.05)


@given(st.integers(0, 2**32), st.floats(1e-8, 5e-5))
def test_a_rough_surface_has_the_asked_rms_about_its_mean(seed, rms):
    height = rough_surface(rms, np.random.default_rng(seed))
    assert math.sqrt(np.mean(height**2)) == pytest.approx(rms, rel=1e-6)
    assert abs(height.mean()) < 1e-6 * rms + 1e-15
