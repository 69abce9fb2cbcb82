"""Resonances that are excited at their base."""

import numpy as np
from numpy.typing import NDArray


def base_excited(ratio: NDArray[np.floating], damping: float, gain: float = 1.0) -> NDArray[np.complex128]:
    """Transmissibility of a base-excited resonance times a gain, shape (frequency,) [1].

    ``(1 + 2 i zeta r) / (1 - r^2 + 2 i zeta r)`` with ``r = f / f_mode`` (S. S. Rao, Mechanical Vibrations, section 3.6), given as
    ``ratio``, shape (frequency,).
    """
    loss = 2j * damping * ratio
    return gain * (1 + loss) / (1 - ratio**2 + loss)
