"""Half-sine pulses of force, with the momentum of the pulse at any step.

The value of a pulse at a node is its mean under the hat that is 1 at this node and 0 at its neighbours: the second difference of the
displacement of a free mass under the pulse, over the square of the step. The hats of all nodes add up to 1, so the values at the nodes have
the momentum of the pulse, however short it is.
"""

import math

from numba import njit

from gen.physics.kernel.compiling import INLINE


@njit(**INLINE)
def pushed(since: float, seconds: float) -> float:
    """Displacement of a free unit mass under a half sine of unit force and given length, ``since`` seconds after its start [s2]."""
    if since <= 0.0:
        return 0.0
    phase = math.pi * since / seconds
    if phase >= math.pi:
        return (seconds / math.pi) ** 2 * (2 * phase - math.pi)
    return (seconds / math.pi) ** 2 * (phase - math.sin(phase))


@njit(**INLINE)
def second_difference(since: float, seconds: float, step: float) -> float:
    """Second difference of :func:`pushed` over ``step`` seconds [s2]."""
    return pushed(since + step, seconds) - 2 * pushed(since, seconds) + pushed(since - step, seconds)
