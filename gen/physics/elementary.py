"""Elementary functions with the same bits on every machine: the C library's, number by number.

NumPy's own differ in the last bit between processors with AVX2 and with AVX-512; its sines, cosines, square roots and sums do not.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

_pow, _exp, _log10 = np.frompyfunc(math.pow, 2, 1), np.frompyfunc(math.exp, 1, 1), np.frompyfunc(math.log10, 1, 1)


def power(base: ArrayLike, exponent: ArrayLike) -> FloatArray:
    """``base`` to the ``exponent``, of the shape they have together; roots of Hertz contacts, the usual case, are square roots.

    >>> power([4.0, 9.0], 0.5)
    array([2., 3.])
    """
    if np.all(np.equal(exponent, 0.5)):
        return np.sqrt(np.broadcast_to(base, np.broadcast_shapes(np.shape(base), np.shape(exponent))))
    return np.asarray(_pow(base, exponent), dtype=np.float64)


def exponential(x: ArrayLike) -> FloatArray:
    """``e`` to the ``x``, of the shape of ``x``."""
    return np.asarray(_exp(x), dtype=np.float64)


def decibels(ratio: ArrayLike) -> FloatArray:
    """A ratio of amplitudes, of its shape [dB].

    >>> decibels([1.0, 10.0])
    array([ 0., 20.])
    """
    return 20 * np.asarray(_log10(ratio), dtype=np.float64)
