"""Laws of the functions that replace those of the processor and of the C library in the kernel."""

import numpy as np
from numba import njit

from gen.physics.kernel.compiling import square_root


@njit
def roots(x):
    out = np.empty_like(x)
    for i in range(len(x)):
        out[i] = square_root(x[i])
    return out


def test_square_roots_are_right_to_the_last_bits_and_that_of_zero_is_zero():
    """Between 1e-40 and 1e6; the eighth root of rollers takes roots of roots."""
    x = 10 ** np.random.default_rng(0).uniform(-40, 6, 200_000)
    np.testing.assert_allclose(roots(x), np.sqrt(x), rtol=7e-16, atol=0)
    assert roots(np.zeros(1))[0] == 0.0
