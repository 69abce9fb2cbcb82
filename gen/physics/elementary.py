"""Elementary functions of arrays with the same bits on every processor.

The power, exponential and logarithm of NumPy differ in the last bit between processors with AVX2 and with AVX-512, so these call the C
library for each number. The sines, cosines, square roots and sums of NumPy have the same bits on both.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

_pow, _exp, _log10 = np.frompyfunc(math.pow, 2, 1), np.frompyfunc(math.exp, 1, 1), np.frompyfunc(math.log10, 1, 1)


def power(base: ArrayLike, exponent: ArrayLike) -> FloatArray:
    """``base`` to the ``exponent``, of their broadcast shape; an exponent of 0.5, the usual one, is a square root.

    >>> power([4.0, 9.0], 0.5)
    array([2., 3.])
    """
    if np.all(np.equal(exponent, 0.5)):
        return np.sqrt(np.broadcast_to(base, np.broadcast_shapes(np.shape(base), np.shape(exponent))))
    return np.asarray(_pow(base, exponent), dtype=np.float64)


def exponential(x: ArrayLike) -> FloatArray:
    """Exponential function, of the shape of ``x``."""
    return np.asarray(_exp(x), dtype=np.float64)


def decibels(ratio: ArrayLike) -> FloatArray:
    """Level of a ratio of amplitudes, of the shape of ``ratio`` [dB].

    >>> decibels([1.0, 10.0])
    array([ 0., 20.])
    """
    return 20 * np.asarray(_log10(ratio), dtype=np.float64)


def standard_normals(numbers: NDArray[np.integer], seed: int) -> FloatArray:
    """Standard normal random numbers, functions of whole numbers and a seed, of the shape of ``numbers``.

    Those of :mod:`gen.physics.kernel.chance`, to rounding.
    """
    from scipy.special import (
        xlogy,
    )  # its logarithm is that of the C library; SciPy loads for 0.2 s, and reading a recipe does not need it

    first, second = (_uniforms(2 * numbers.astype(np.int64) + part, seed) for part in (0, 1))
    return np.sqrt(-2 * xlogy(1.0, first)) * np.cos(2 * np.pi * second)


def _uniforms(numbers: NDArray[np.int64], seed: int) -> FloatArray:
    """Random numbers in (0, 1): the finaliser of SplitMix64."""
    x = numbers.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(seed)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((x ^ (x >> np.uint64(31))) >> np.uint64(12)).astype(np.float64) / 2.0**52 + 0.5 / 2.0**52
