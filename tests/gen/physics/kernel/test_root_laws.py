"""The square root in software has the bits of the processor's, so each machine may choose how many roots its divider takes.

The ninth root, of rollers, is one to the last digits.
"""

import math

import numpy as np
import pytest
from numba import njit

from gen.physics.kernel.compiling import ninth_root, root, square_root

SMALLEST = 2.0**-968  # below it the remainder of the last correction is too small for its last bits


def of_each(root_of):
    """Function of arrays, compiled as the kernel is, from one of numbers that it inlines."""

    @njit
    def every(x):
        out = np.empty_like(x)
        for i in range(len(x)):
            out[i] = root_of(x[i])
        return out

    return every


roots, chosen_roots, ninth_roots = map(of_each, (square_root, root, ninth_root))


def test_the_ninth_root_is_one():
    x = np.r_[np.geomspace(1e-290, 1e3, 100_001), 1.0, np.nextafter([1.0, 2.0, 4.0], 0)]
    exact = np.longdouble(x) ** (1 / np.longdouble(9))
    assert np.abs(ninth_roots(x) / exact - 1).max() < 1e-14
    assert 0 <= ninth_roots(np.zeros(1))[0] < 1e-30


def hardest(nearest):
    """Numbers in [1, 4) whose roots lie nearest to the middle of two floating-point numbers.

    A middle is ``n / 2**53`` with an odd ``n`` from 2**53 on, and a number of 53 bits is ``m / 2**52`` below 2, or ``m / 2**51`` from 2 on.
    The root of the number is the middle less about ``k / 2**107 / n``, where ``k = n**2 - m * 2**54``, or ``n**2 - m * 2**55``. So all
    numbers with ``abs(k) < nearest`` come from the square roots ``n`` of each ``k`` modulo 2**54 and 2**55, of which an odd ``k`` has four
    if it is 1 modulo 8, and none otherwise.
    """
    numbers = []
    for bits, unit in ((54, 2.0**-52), (55, 2.0**-51)):
        modulus = 1 << bits
        for k in range(1 - nearest // 8 * 8, nearest, 8):
            n = 1
            for bit in range(3, bits):  # n is a square root modulo 2**bit; make it one modulo 2**(bit + 1)
                if (n * n - k) >> bit & 1:
                    n += 1 << (bit - 1)
            for some in {n, -n, n + modulus // 2, modulus // 2 - n}:
                middle = some % modulus
                m = (middle * middle - k) >> bits
                if middle >> 53 == 1 and 1 <= m * unit < 4 and (m * unit < 2) == (bits == 54):
                    numbers.append(m * unit)
    return np.array(numbers)


def test_the_root_is_right_where_it_is_hardest_to_round():
    """The error before the last rounding is below 1.4e-30 of the root, so it can decide only where ``abs(k)`` is below 910.

    Before the last correction, root and half of its inverse are each wrong by less than 9e-16: 5.3e-16 of the series and 2.8e-16 of
    rounding. The correction is then wrong by less than 1.5e-15 of itself, and it is at most 9e-16 of the root.
    """
    x = hardest(4096)
    assert len(x) > 1000
    assert {1 + 2.0**-52, 4 - 2.0**-51} <= set(x)
    np.testing.assert_array_equal(roots(x), np.sqrt(x))


@pytest.mark.parametrize("exponent", [-900, -41, -40, 0, 1, 500])
def test_the_root_is_right_for_random_numbers_of_even_and_odd_exponents(exponent):
    x = np.ldexp(np.random.default_rng(exponent + 1000).uniform(1, 2, 300_000), exponent)
    np.testing.assert_array_equal(roots(x), np.sqrt(x))


def test_the_root_of_zero_is_zero_and_small_and_large_roots_are_right():
    x = np.array([0.0, SMALLEST, np.nextafter(SMALLEST, 1), 1e-30, 1.0, 1e30])
    np.testing.assert_array_equal(roots(x), [math.sqrt(value) for value in x])
    assert math.copysign(1, roots(np.zeros(1))[0]) == 1


def test_the_root_that_this_processor_chooses_has_the_same_bits():
    x = np.concatenate([hardest(256), np.random.default_rng(1).uniform(0, 1, 10_000)])
    np.testing.assert_array_equal(chosen_roots(x), np.sqrt(x))


def test_the_root_is_right_at_squares_and_beside_them():
    x = np.random.default_rng(0).uniform(1e-8, 1, 300_000).astype(np.float32).astype(float) ** 2
    for near in (x, np.nextafter(x, 0), np.nextafter(x, 1)):
        np.testing.assert_array_equal(roots(near), np.sqrt(near))
