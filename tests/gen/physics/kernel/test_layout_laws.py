"""Laws of the arrays of the kernel: every named row is written before the first step."""

from dataclasses import replace

import numpy as np
import pytest

from gen.physics.hertz import LINE_EXPONENT
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.layout import PICKUPS, Param
from gen.physics.kernel_input import Spall, Turning, Waviness, at_rest
from tests.lanes import march_batch
from tests.strategies import RIG, ball_waves, race_waves, record

KNOT, N_KNOTS, N_STEPS = 1 / 12_000, 240, 4
HELD = range(Param.CAGE_TURN_COS, PICKUPS)  # set anew at every knot

MACHINE = RIG._replace(
    contact_damping=100.0, contact_cosine=0.98, shaft_stiffness=1e5, ring_stiffness_x=1e5, ring_stiffness_y=2e5, looseness=1e-7,
    load_deflection_factor=5e8, contact_exponent=LINE_EXPONENT,
)  # fmt: skip
TURNING = Turning(
    shaft_rate=50.0, speed_rms=0.01, mean_slip=0.01, slip_rms=0.01, spin_rms=0.02, jitter_rms=0.005, axis_offset=0.05,
    axis_rms=0.05, axis_limit=0.3, unbalance=1e-4, shaft_angle=0.4, cage_angle=-1.7, spin_angle=0.2, bow=20.0, twice_x=15.0,
    twice_y=10.0, knock=30.0, knock_angle=-1.7, knock_seed=12, late_ball=2, late_by=0.03, walk=0.01, walk_seed=13,
    axis_jumps=0.5, axis_spread=0.05, axis_seed=14,
)  # fmt: skip
RAMP = tuple(np.linspace(0, 4e-6, 9))
SPALLS = (
    Spall("inner", 2e-3, 2e-6, -1.7, scatter=0.2, seed=1),
    Spall("outer", 2e-3, 5e-6, -1.4, profile="table", table=(RAMP,), scatter=0.2, seed=2),
    Spall("ball", 2e-3, 2e-6, 0.5, ball=0, scatter=0.2, seed=3),
)


@pytest.fixture(scope="module")
def laid_out():
    """A shape, and a batch that holds one record with every feature in all its lanes."""
    drawn = record(MACHINE, TURNING, SPALLS)
    drawn = drawn._replace(
        bearing=replace(drawn.bearing, roller_length=8e-3),
        waviness=Waviness(race_waves(3, 5e-8), ball_waves(3, 5e-8)), schedule=np.linspace([0.9, 1.1], [1.1, 0.9], 20),
    )  # fmt: skip
    shape = input_shape(drawn)
    return shape, lay_out(at_rest([drawn]), shape, KNOT)


def test_every_row_that_a_batch_needs_is_written(laid_out):
    _, batch = laid_out
    params = batch.params.reshape(-1, LANES)
    unwritten = {row for row in range(len(params)) if np.isnan(params[row]).any()}
    assert unwritten <= set(HELD)
    for name in ("state", "drive", "angles", "spalls", "phasors", "waves"):
        assert not np.isnan(getattr(batch, name)).any(), name


def test_every_row_that_holds_until_the_next_knot_is_written_before_the_first_step(laid_out):
    trip = march_batch(*laid_out, N_KNOTS, N_STEPS, KNOT)[0]
    assert np.isfinite(trip.accelerations).all()


def test_lanes_behind_the_vector_of_the_last_record_are_not_computed(laid_out):
    first, *_, last = march_batch(*laid_out, N_KNOTS, N_STEPS, KNOT)  # one record, and LANES trips
    assert (first.states[-1] != first.states[0]).any()
    assert (last.states == last.states[0]).all()
