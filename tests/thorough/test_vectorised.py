"""The loop over lanes is vector code. Scalar code would give the same numbers several times slower, and no other test would notice."""

import re

import numpy as np
from numba import njit

from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.layout import STATE_ROWS, Batch, Shape, param_rows
from gen.physics.kernel.step import advance
from gen.simulation.compiled_kernel import DIMENSIONS

BALLS = 4 + 2 + 1  # of which the code of a kind of contact is made
ROOTS = 3 * BALLS  # three kinds of balls; the power of rollers takes multiplications alone
# a square root is an instruction of the processor, or starts from half the exponent, a vector shift by one bit
PACKED_ROOT = re.compile(
    r"\bv?sqrtpd\b|\bfsqrt\s+v\d+\.2d\b|"
    r"\bv?psra[qd]\s+\$1, %[yz]mm|\bv?psr[al]q\s+\$1, %[xyz]mm|\bsshr\s+v\d+\.2d, v\d+\.2d, #1\b"
)
SCALAR = re.compile(r"\bv?sqrtsd\b|\bfsqrt\s+d\d+\b|\bvfn?m(add|sub)\d+sd\b|\bfn?m(add|sub)\s+d\d+\b")


@njit
def advance_once(shape, batch, history):
    advance(shape, batch, 1e-6, 1, 0.0, history, 0, history.size)


def assembly():
    """Code of a step."""
    shape = Shape(9, 1)
    arrays = {name: np.empty((0,) * DIMENSIONS.get(name, 1)) for name in Batch._fields}
    arrays |= {"state": np.zeros(STATE_ROWS * LANES), "params": np.ones(param_rows(shape, 1) * LANES)}
    advance_once(shape, Batch(**arrays | {"n_records": LANES}), np.zeros(LANES))
    return advance_once.inspect_asm(advance_once.signatures[-1])


def test_the_force_of_every_kind_of_contact_is_computed_for_several_records_at_once():
    code = assembly()
    assert len(PACKED_ROOT.findall(code)) >= ROOTS
    assert not SCALAR.search(code)
