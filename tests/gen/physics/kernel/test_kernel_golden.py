"""The kernel compared with right-hand sides and trajectories of other implementations, stored in tests/golden/model.json."""

import json

import numpy as np
import pytest

from gen.physics.bearing import Bearing
from gen.physics.kernel.layout import n_process_terms
from gen.physics.kernel_input import KernelInput, Spall, Turning
from gen.physics.rotor import Machine
from tests.lanes import EVERY_ACCELERATION, march_lanes
from tests.paths import GOLDEN
from tests.reference_motion import slow_motion

GOLDEN = json.loads((GOLDEN / "model.json").read_text())
START = np.array(GOLDEN["start"])
KNOT = 1 / 12_000
STEPS_AT_192_KHZ = 16


def golden_record(half_clearance, *, with_spalls):
    bearing = Bearing("golden", **GOLDEN["bearing"])
    still = np.zeros(n_process_terms(bearing.n_balls))
    return KernelInput(
        bearing=bearing,
        machine=Machine(**GOLDEN["machine"])._replace(half_clearance=half_clearance),
        turning=Turning(**GOLDEN["motion"]),
        spalls=tuple(Spall(**spall) for spall in GOLDEN["spalls"]) if with_spalls else (),
        frequencies=still,
        phases=still,
        pickups=EVERY_ACCELERATION,
    )


def later(record, time):
    """The record advanced by ``time``: rates are constant, so one knot gives the angles."""
    shaft, cage, spin = slow_motion(record, time, 1).angles[1] if time else slow_motion(record, 1.0, 0).angles[0]
    return record._replace(turning=record.turning._replace(shaft_angle=shaft, cage_angle=cage, spin_angle=spin))


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
