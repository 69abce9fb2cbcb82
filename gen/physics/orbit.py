"""Elliptical motion of a machine at one frequency."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.floating]


def along(
    directions: FloatArray, forward: FloatArray, backward: FloatArray, flatness: FloatArray
) -> NDArray[np.complex128]:
    """Complex amplitudes of elliptical motions along ``directions`` [rad], shape (direction, line) [1].

    An ellipse is the sum of a vector that turns with the shaft and one that turns against it, with the phases ``forward`` and
    ``backward`` [rad]; ``flatness`` is the ratio of their lengths: 0 for a circle, 1 for a straight line. Each has shape (line,). See
    A. Muszynska, Rotordynamics, CRC Press, 2005.
    """
    turned: NDArray[np.complex128] = np.exp(-1j * directions)[:, None]
    return np.exp(1j * forward) * turned + flatness * np.exp(1j * backward) * np.conj(turned)
