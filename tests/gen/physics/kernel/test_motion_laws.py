"""Laws of the motion of shaft, cage, balls and spalls between the knots."""

import numpy as np
import pytest
from hypothesis import given, settings

from gen.physics.bearing import slipping_orders
from gen.physics.inputs import Turning
from tests.lanes import march_lanes
from tests.reference import turned
from tests.strategies import RIG, record, wandering_records

KNOT = 1 / 12_000


@settings(max_examples=3)
@given(wandering_records())
def test_angles_and_directions_are_still_exact_after_ten_thousand_knots(drawn):
    trip = march_lanes([drawn], 10_000, 1, KNOT)[0]
    exact = turned(drawn, KNOT, 10_000)[0]
    np.testing.assert_allclose(trip.angles, exact, rtol=0, atol=1e-9)
    cage, shaft = exact[:, 1], exact[:, 0]
    directions = np.stack([np.cos(cage), np.sin(cage), np.cos(shaft), np.sin(shaft)], axis=1)
    np.testing.assert_allclose(trip.directions, directions, rtol=0, atol=1e-9)


def test_the_distances_between_successive_balls_at_the_outer_race_are_independent_and_as_scattered_as_drawn():
    """The angle of the cage walks at random: its variance grows in proportion to time, from one ball to many."""
    seats, n_knots, walk = 16, 9600, 0.02
    drawn = [record(RIG, Turning(50.0, walk=walk, walk_seed=seed)) for seed in range(seats)]
    cages = np.array([trip.angles[:, 1] for trip in march_lanes(drawn, n_knots, 1, KNOT)])
    mean = 2 * np.pi * 50.0 * slipping_orders(drawn[0].bearing, 0.0).ftf * KNOT
    apart, away = 2 * np.pi / 9, cages - mean * np.arange(n_knots + 1)
    for balls in (1, 4):
        knots = round(balls * apart / mean)
        steps = np.diff(away[:, ::knots], axis=1)
        # 16 lanes of 35 or 143 passages: the standard deviation has a standard error of at most 3 %
        assert steps.std() == pytest.approx(walk * apart * np.sqrt(balls), rel=0.1)
        follower = np.corrcoef(steps[:, :-1].ravel(), steps[:, 1:].ravel())[0, 1]
        assert abs(follower) < 0.15
