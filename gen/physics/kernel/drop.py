"""How far a ball drops as it rolls over a spall.

A rigid ball over a gap rests on one edge up to the middle and on the other edge after it. Its drop is the sagitta of the ball, plus that of
a convex (inner) or minus that of a concave (outer) raceway, and at most the depth of the spall. For two sharp edges this path is exact.
The half-sine, raised-cosine and rectangular profiles of the literature are there for comparison.
"""

import math

from numba import njit

from gen.physics.kernel.compiling import CALLED, cosine, in_both, sine

PROFILES = ("geometric", "half_sine", "raised_cosine", "rectangular", "table")
GEOMETRIC, HALF_SINE, RAISED_COSINE, RECTANGULAR, TABLE = range(5)
RAISED_EDGE = 0.25  # share of the half width taken by each cosine flank
FAR_INSIDE = 0.7  # rad from an edge, within the range of sine()


@in_both
def sagitta(chord: float, radius: float) -> float:
    """Height of an arc of signed ``radius`` over half its ``chord`` [m].

    >>> round(float(sagitta(3.0, 5.0)), 12), round(float(sagitta(3.0, -5.0)), 12)
    (1.0, -1.0)
    """
    return radius - math.copysign(math.sqrt(max(radius * radius - chord * chord, 0.0)), radius)


@njit(**CALLED)
def drop(profile: int, offset: float, half: float, arc: float, ball: float, race: float, depth: float) -> float:
    """Drop of a ball whose contact is ``offset`` from the centre of a spall [m].

    Parameters
    ----------
    profile : int
        One of ``GEOMETRIC``, ``HALF_SINE``, ``RAISED_COSINE``, ``RECTANGULAR``.
    offset, half : float
        Angle from the centre, and half the angle the spall spans [rad].
    arc : float
        Radius on which those angles are measured [m].
    ball, race : float
        Radius of the ball, and of the race: positive if convex (inner), negative if concave (outer) [m].
    depth : float
        Depth of the spall [m].
    """
    from_edge = half - abs(offset)
    inside = max(from_edge, 0.0)
    if profile == GEOMETRIC:
        chord = min(arc * sine(min(inside, FAR_INSIDE)), ball)
        value = min(sagitta(chord, ball) + sagitta(chord, race), depth)
    elif profile == HALF_SINE:
        value = depth * max(cosine(0.5 * math.pi * min(abs(offset) / half, 1.0)), 0.0)
    elif profile == RAISED_COSINE:
        flank = cosine(0.5 * math.pi * min(inside / (RAISED_EDGE * half), 1.0))
        value = depth * (1 - flank * flank)
    else:
        value = depth
    return value if from_edge > 0.0 else 0.0
