"""Random numbers that are functions of a count and a seed, so that an event needs no memory of the events before it."""

import math

import numpy as np
from numba import njit

from gen.physics.kernel.compiling import INLINE


@njit(**INLINE)
def uniform(number: float, seed: float) -> float:
    """Random number in (0, 1), a function of the whole numbers ``number`` and ``seed``: the finaliser of SplitMix64."""
    x = np.uint64(np.int64(number)) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(np.int64(seed))
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x ^= x >> np.uint64(31)
    return (np.float64(x >> np.uint64(12)) + 0.5) / 2.0**52


@njit(**INLINE)
def standard_normal(number: float, seed: float) -> float:
    """Standard normal random number, a function of the whole numbers ``number`` and ``seed`` (Box and Muller)."""
    return math.sqrt(-2 * math.log(uniform(2 * number, seed))) * math.cos(2 * math.pi * uniform(2 * number + 1, seed))
