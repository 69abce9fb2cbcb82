"""Laws of the places where the mass of a ball strikes the edges of a spall, and of the length of such an impact."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.catalogue import CATALOGUE
from gen.physics.extent import MOST_STRIKES
from gen.physics.impact import edge_strikes, hertz_time, path_strikes, rolling_mass
from gen.physics.kernel.drop import GEOMETRIC, drop
from gen.physics.trace import ball_path, spall_positions
from tests.strategies import depths, widths

law = settings(deadline=None, max_examples=100)
BEARING = CATALOGUE["6205"]
BALL = BEARING.ball_diameter / 2
RACES = {"inner": BEARING.inner_radius, "outer": -BEARING.outer_radius}
races = st.sampled_from(sorted(RACES.values()))


@law
@given(widths, races, depths)
def test_a_strike_is_the_change_of_the_slope_of_the_path(width, race, depth):
    arc, step = abs(race), 1e-9
    half = width / 2 / arc

    def height(offset):
        return -drop(GEOMETRIC, offset, half, arc, BALL, race, depth)

    for offset, change, spread in edge_strikes(width, arc, BALL, race, depth):
        before, after = ((height(offset + side * step) - height(offset)) / (arc * step) for side in (-1, 1))
        assert spread == 0.0
        assert before + after == pytest.approx(change, rel=1e-3, abs=1e-5)


@law
@given(widths, races, depths)
def test_a_ball_strikes_a_narrow_spall_once_and_a_wide_one_at_either_end_of_its_floor(width, race, depth):
    arc = abs(race)
    found = edge_strikes(width, arc, BALL, race, depth)
    bridged = drop(GEOMETRIC, 0.0, width / 2 / arc, arc, BALL, race, 1.0) <= depth
    assert len(found) == (1 if bridged else 2)
    assert sum(strike.offset for strike in found) == pytest.approx(0.0, abs=1e-15)


def test_a_ball_over_a_narrow_spall_changes_its_slope_by_the_width_over_the_relative_radius():
    """The chord is small against ball and race, so the sagittas are parabolas."""
    for race in RACES.values():
        (strike,) = edge_strikes(0.2e-3, abs(race), BALL, race, 1e-3)
        assert strike.change == pytest.approx(0.2e-3 * (1 / BALL + 1 / race), rel=1e-3)


@law
@given(widths, races, depths)
def test_the_strikes_over_a_table_are_those_over_the_edges_it_was_made_from(width, race, depth):
    arc = abs(race)
    path = ball_path(np.full(9, depth), width, BALL, race)
    made, exact = path_strikes(path, width, arc), edge_strikes(width, arc, BALL, race, depth)
    # a table has an arc of the path between two points, which bends the other way
    lost = 4 * width / len(path) * (1 / BALL + 1 / race)
    assert sum(strike.change for strike in made) == pytest.approx(
        sum(strike.change for strike in exact), abs=lost, rel=0.02
    )
    assert len(made) <= MOST_STRIKES


def test_a_smooth_path_that_bends_towards_the_race_alone_has_no_strike():
    assert path_strikes(spall_positions(1e-3) ** 2, 1e-3, 0.02) == ()


def test_a_ball_of_twice_the_diameter_strikes_for_twice_the_time():
    """Mass by 8, radius by 2: the fifth root of 8^2 / 2 is 2."""
    larger = replace(BEARING, ball_diameter=2 * BEARING.ball_diameter)
    assert rolling_mass(larger) == pytest.approx(8 * rolling_mass(BEARING))
    assert hertz_time(larger) == pytest.approx(2 * hertz_time(BEARING))


def test_a_roller_has_the_mass_of_a_cylinder():
    roller = replace(BEARING, rolling_element="roller", roller_length=8e-3)
    assert rolling_mass(roller) == pytest.approx(7800 * math.pi * BALL**2 * 8e-3)
