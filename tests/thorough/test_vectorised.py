"""The loop over lanes is vector code. Scalar code would give the same numbers several times slower, and no other test would notice."""

import re

import numpy as np
import pytest
from numba import njit

from gen.physics.catalogue import CATALOGUE
from gen.physics.extent import MAX_BALLS
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.layout import STATE_ROWS, Batch, make_shape, param_rows
from gen.physics.kernel.step import advance
from gen.simulation.kernels import DIMENSIONS

STAGES = 2  # stages that the assembly holds as separate code, each with the force of every ball
# a square root is an instruction of the processor, or starts from half the exponent, a vector shift by one bit
PACKED_ROOT = re.compile(
    r"\bv?sqrtpd\b|\bfsqrt\s+v\d+\.2d\b|"
    r"\bv?psra[qd]\s+\$1, %[yz]mm|\bv?psr[al]q\s+\$1, %[xyz]mm|\bsshr\s+v\d+\.2d, v\d+\.2d, #1\b"
)
EVERYTHING = {
    "resonator": True,
    "wavy": True,
    "spalled": True,
    "jittered": True,
    "damped": True,
    "forced": True,
    "loose": True,
}
VARIANTS = [{}, EVERYTHING, EVERYTHING | {"displacement": True}, {"roller": True}]
BALL_COUNTS = sorted({bearing.n_balls for bearing in CATALOGUE.values()})


@njit
def advance_once(shape, batch, history):
    advance(shape, batch, 1e-6, 1, 0.0, history, 0)


def assembly(shape):
    """Code of a step; each takes three seconds to compile."""
    arrays = {name: np.empty((0,) * DIMENSIONS.get(name, 1)) for name in Batch._fields}
    arrays |= {"state": np.zeros(STATE_ROWS * LANES), "params": np.ones(param_rows(shape, 1) * LANES)}
    advance_once(shape, Batch(**arrays | {"n_records": LANES}), np.zeros(LANES))
    return advance_once.inspect_asm(advance_once.signatures[-1])


@pytest.mark.parametrize("n_balls", [BALL_COUNTS[0], BALL_COUNTS[len(BALL_COUNTS) // 2], BALL_COUNTS[-1], MAX_BALLS])
def test_the_force_of_every_ball_is_computed_for_several_records_at_once(n_balls):
    code = assembly(make_shape(n_balls, 1, resonator=True, wavy=True, spalled=True, jittered=True, damped=True))
    assert len(PACKED_ROOT.findall(code)) >= STAGES * n_balls


@pytest.mark.parametrize("flags", VARIANTS, ids=lambda flags: "+".join(flags) or "plain")
def test_every_variant_of_the_model_is_vector_code(flags):
    roots = 3 if "roller" in flags else 1
    code = assembly(make_shape(9, 1, **flags))
    assert len(PACKED_ROOT.findall(code)) >= STAGES * 9 * roots
