"""A sensor that lifts off and strikes the machine because its mount can push harder than it can pull; and a machine on its support.

``held`` is the acceleration of the sensor on a mount that never lets go, and ``d`` the distance from that motion. The mount pulls with the
holding acceleration ``h`` (force over mass of the sensor) at most::

    d'' = max(-omega^2 d - 2 zeta omega d', -h - held)
    acceleration of the sensor = held + d''

With the first term the sensor is on its mount and ``d`` is a damped oscillation; with the second it flies. Each landing is an impact, after
which it may lift off again. Without a flight ``d`` stays 0 and the sensor measures ``held``.
"""

import math

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel.compiling import compiled_to_disk

FloatArray = NDArray[np.floating]

FINENESS = 0.05  # rad of the mount's oscillation in a step: a landing found one step late adds at most 0.3 % of energy
AT_REST = 1e-9  # of the holding acceleration: force of an oscillation that has decayed


def rattling(
    held: FloatArray, frequency: float, damping: float, holding: float, fs: float
) -> tuple[NDArray[np.float64], int]:
    """Acceleration of a sensor that lifts off where it is not held hard enough, shape (time,) [m s-2], and the number of impacts.

    Parameters
    ----------
    held : array, shape (time,)
        Acceleration on a mount that never lets go [m s-2].
    frequency, damping : float
        Natural frequency [Hz] and damping ratio of the sensor on its mount.
    holding : float
        Force that holds the sensor over its mass [m s-2].
    fs : float
        Sample rate [Hz].
    """
    omega = 2 * math.pi * frequency
    steps = math.ceil(omega / fs / FINENESS)
    step, decay, turn = 1 / (fs * steps), damping * omega, omega * math.sqrt(1 - damping**2)
    fading, c, s = math.exp(-decay * step), math.cos(turn * step), math.sin(turn * step)
    # d and d' after one step of the free damped oscillation
    advance = (
        fading * (c + decay / turn * s), fading * s / turn,
        -fading * omega**2 / turn * s, fading * (c - decay / turn * s),
    )  # fmt: skip
    return _rattle(held.astype(float), omega, 2 * decay, holding, step, steps, advance)


def compile_rattling() -> None:
    """Compile the flights, or fetch them from numba's cache on disk."""
    rattling(np.zeros(2), 1000.0, 0.1, 1.0, 10_000.0)


@compiled_to_disk
def _rattle(
    held: NDArray[np.float64],
    omega: float,
    loss: float,
    holding: float,
    step: float,
    steps: int,
    advance: tuple[float, float, float, float],
) -> tuple[NDArray[np.float64], int]:
    measured = np.empty(len(held))
    d, velocity, flying, impacts = 0.0, 0.0, False, 0
    for k in range(len(held)):
        now, following = held[k], held[min(k + 1, len(held) - 1)]
        measured[k] = max(now - omega**2 * d - loss * velocity, -holding)
        if d == 0.0 and velocity == 0.0 and min(now, following) >= -holding:
            continue
        for j in range(steps):
            lift = -holding - (now + (following - now) * (j / steps))
            if -(omega**2) * d - loss * velocity < lift:
                d += step * (velocity + 0.5 * step * lift)
                velocity += step * lift
                flying = True
            else:
                d, velocity = advance[0] * d + advance[1] * velocity, advance[2] * d + advance[3] * velocity
                impacts += flying
                flying = False
        if not flying and omega * abs(omega * d) + omega * abs(velocity) < AT_REST * holding:
            d, velocity = 0.0, 0.0
    return measured, impacts
