"""Laws of the geometry: fault frequencies equal counted passages."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.bearing import free_contact_angle, orders, slipping_orders
from tests.strategies import bearings

slips = st.floats(-0.1, 0.2)


@given(bearings(), slips)
def test_slip_takes_from_the_outer_race_what_it_gives_to_the_inner_one(bearing, slip):
    rolling, slipping = orders(bearing), slipping_orders(bearing, slip)
    assert slipping.bpfo == pytest.approx(rolling.bpfo * (1 - slip), rel=1e-12)
    assert slipping.bpfo + slipping.bpfi == pytest.approx(bearing.n_balls, rel=1e-12)


@given(bearings())
def test_balls_roll_without_sliding_on_both_races(bearing):
    """Surface speeds in the frame of the cage, in which ball centres are at rest [pitch diameters times shaft rate]."""
    of_bearing = orders(bearing)
    ball = of_bearing.bsf * bearing.ball_diameter
    assert ball == pytest.approx((1 - of_bearing.ftf) * 2 * bearing.inner_radius, rel=1e-12)
    assert ball == pytest.approx(of_bearing.ftf * 2 * bearing.outer_radius, rel=1e-12)


@given(bearings(), slips)
def test_balls_counted_over_a_mark_on_either_race_come_at_the_ball_pass_orders(bearing, slip):
    slipping = slipping_orders(bearing, slip)
    turns = 1000
    places = np.arange(bearing.n_balls) / bearing.n_balls
    over_outer = np.floor(places + turns * slipping.ftf) - np.floor(places)
    over_inner = np.floor(places + turns * (1 - slipping.ftf)) - np.floor(places)
    assert over_outer.sum() == pytest.approx(turns * slipping.bpfo, abs=1.01)
    assert over_inner.sum() == pytest.approx(turns * slipping.bpfi, abs=1.01)


@given(bearings(), st.floats(0, 1e-4))
def test_a_bearing_moved_along_its_axis_to_the_free_angle_closes_its_clearance(bearing, clearance):
    """The centres of the grooves, apart by A less half the clearance in the radial direction, are then apart by A."""
    apart = (bearing.inner_conformity + bearing.outer_conformity - 1) * bearing.ball_diameter
    angle = free_contact_angle(bearing, clearance)
    if angle < math.pi / 2:
        assert apart * (1 - math.cos(angle)) == pytest.approx(clearance / 2, abs=1e-12)
    assert free_contact_angle(bearing, -clearance) == 0
    assert free_contact_angle(replace(bearing, rolling_element="roller", roller_length=0.01), clearance) == 0
