"""The kernel against right-hand sides and trajectories of other implementations, in tests/golden/model.json."""

import json
from pathlib import Path

import numpy as np
import pytest

from gen.physics.batch import Motion, Record, Spall, n_terms
from gen.physics.bearing import Bearing
from gen.physics.rotor import Machine
from tests.reference import EVERY_ACCELERATION, march_lanes, slow_motion

GOLDEN = json.loads((Path(__file__).parents[1] / "golden" / "model.json").read_text())
START = np.array(GOLDEN["start"])
KNOT = 1 / 12_000
STEPS_AT_192_KHZ = 16


def golden_record(half_clearance, *, with_spalls):
    bearing = Bearing("golden", **GOLDEN["bearing"])
    still = np.zeros(n_terms(bearing.n_balls))
    return Record(
        bearing,
        Machine(**GOLDEN["machine"])._replace(half_clearance=half_clearance),
        Motion(**GOLDEN["motion"]),
        tuple(Spall(**spall) for spall in GOLDEN["spalls"]) if with_spalls else (),
        still,
        still,
        EVERY_ACCELERATION,
        np.empty(0),
    )


def later(record, time):
    """The record as it stands after ``time``: the rates hold, so one knot is enough to know the angles."""
    shaft, cage, spin = slow_motion(record, time, 1).angles[1] if time else slow_motion(record, 1.0, 0).angles[0]
    return record._replace(motion=record.motion._replace(shaft_angle=shaft, cage_angle=cage, spin_angle=spin))


@pytest.mark.parametrize("case", GOLDEN["right_hand_sides"], ids=lambda case: f"t={case['time']}")
def test_the_right_hand_side_with_three_spalls_is_the_golden_one(case):
    record = later(golden_record(GOLDEN["machine"]["half_clearance"], with_spalls=True), case["time"])
    trip = march_lanes([record], 1, STEPS_AT_192_KHZ, KNOT, START)[0]
    derivative = np.concatenate([trip.states[0, 6:], trip.accelerations[0]])
    np.testing.assert_allclose(derivative, case["derivative"], rtol=1e-10, atol=0)


@pytest.mark.parametrize("case", GOLDEN["trajectories"], ids=lambda case: case["name"])
def test_a_trajectory_of_twenty_milliseconds_ends_where_the_golden_one_does(case):
    record = golden_record(case["half_clearance"], with_spalls=case["spalls"])
    n_knots = round(case["time"] / KNOT)
    trip = march_lanes([record], n_knots, STEPS_AT_192_KHZ, KNOT, START)[0]
    np.testing.assert_allclose(trip.states[-1, :6], case["state"][:6], rtol=0, atol=case["tolerance"])
