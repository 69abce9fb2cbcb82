"""The loop over lanes is vector code: scalar code would be several times slower and give the same numbers, so nothing else would tell."""

import re

import numpy as np
import pytest

from gen.physics.integrate import integrate_lanes
from gen.physics.kernel import N_STATE, jitter_row, make_shape
from gen.physics.lanes import LANES
from gen.physics.motion import ANGLE_ROWS, DRIVE_ROWS, JITTER_FIRST, JITTER_TERMS, SPALL_ROWS, TABLE_POINTS, Lanes

STAGES = 4  # of a Runge-Kutta step, each with the force of every ball
PACKED_SQUARE_ROOT = re.compile(r"\bv?sqrtpd\b|\bfsqrt\s+v\d+\.2d\b")


def standing_still(shape):
    """A batch of nothing, for the compiler to see."""
    n_terms = JITTER_FIRST + JITTER_TERMS * len(shape.balls)
    rows = (N_STATE, jitter_row(shape), DRIVE_ROWS, ANGLE_ROWS, SPALL_ROWS, 4 * n_terms, 0)
    flat = (np.zeros(n * LANES) for n in rows)
    return Lanes(*flat, np.zeros((0, 2, LANES)), np.zeros((1, TABLE_POINTS)))


# what most recipes need, everything at once, and rollers: each takes ten seconds to compile
@pytest.mark.parametrize(
    ("n_balls", "flags"),
    [
        (9, {"resonator": True, "uneven": True, "jittered": True}),
        (8, {"resonator": True, "uneven": True, "jittered": True, "damped": True, "forced": True, "loose": True}),
        (13, {"roller": True, "uneven": True}),
    ],
)
def test_the_force_of_every_ball_is_computed_for_several_records_at_once(n_balls, flags):
    shape = make_shape(n_balls, 1, **flags)
    integrate_lanes(shape, standing_still(shape), 1e-5, 1, np.ones(1), 0, 1)
    assembly = integrate_lanes.inspect_asm()[integrate_lanes.signatures[-1]]
    assert len(PACKED_SQUARE_ROOT.findall(assembly)) >= STAGES * n_balls
