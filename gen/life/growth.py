"""Growth of a spall along the rolling direction.

``da/dN = A (P/C)^q (a / 1 mm)^m exp(e)`` per turn, and ``acceleration`` times as much beyond a critical length: measured spalls grow
slowly at first and then much faster [1]_. Only ``(P/C)^q exp(e)``, the drive, changes with time, so the length is a closed form of the sum
of the drive over the turns. ``e`` is the noise of :mod:`gen.life.ageing`.

.. [1] L. Rosado, N. H. Forster, K. L. Thompson, J. W. Cooke, "Rolling contact fatigue life and spall propagation of AISI M50, M50NiL, and
   AISI 52100, part I: experimental results", Tribology Transactions 53 (2009) 29-41.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

MILLIMETRE = 1e-3


class Growth(NamedTuple):
    """Law of growth."""

    rate: float
    """``A``: of a spall of 1 mm at a load of the dynamic rating [m per turn]."""
    exponent: float
    """``m`` [1]."""
    critical: float
    """Length beyond which it grows faster [m]."""
    acceleration: float
    """Factor of the rate beyond that length [1]."""


def drive_between(law: Growth, first: float, last: float) -> float:
    """Drive in which a spall grows from one length to another, both in m [turns at the dynamic rating].

    >>> drive_between(Growth(1e-9, 0.0, 1.0, 1.0), 1e-3, 3e-3)
    2000000.0
    """
    turn = min(max(law.critical, first), last)
    return _drive(law, first, turn) + _drive(law, turn, last) / law.acceleration


def length_after(law: Growth, first: float, drive: ArrayLike) -> NDArray[np.float64]:
    """Length that a spall of ``first`` m has after a drive, in the shape of ``drive`` [m]; infinite where growth has no limit."""
    drive = np.asarray(drive, np.float64)
    turn = max(law.critical, first)
    before = _drive(law, first, turn)
    slow, fast = _length(law, first, drive), _length(law, turn, law.acceleration * (drive - before))
    return np.where(drive <= before, slow, fast)


def _drive(law: Growth, first: float, last: float) -> float:
    """Drive between two lengths at the rate of small spalls."""
    return _scale(law, first) * _integral(math.log(last / first), 1 - law.exponent)


def _integral(logarithm: float, power: float) -> float:
    return logarithm if power == 0 else math.expm1(power * logarithm) / power


def _length(law: Growth, first: float, drive: NDArray[np.float64]) -> NDArray[np.float64]:
    share, power = np.maximum(drive, 0.0) / _scale(law, first), 1 - law.exponent
    if power == 0:
        return first * np.exp(np.minimum(share, 700.0))
    with np.errstate(divide="ignore"):
        return first * np.maximum(1 + power * share, 0.0) ** (1 / power)


def _scale(law: Growth, length: float) -> float:
    """Drive in which a spall would double its length at the rate that it has [turns]."""
    return length / law.rate * (length / MILLIMETRE) ** -law.exponent
