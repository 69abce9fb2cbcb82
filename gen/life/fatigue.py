"""Rating life of rolling bearings, and the scatter of single lives about it.

ISO 281 [1]_ gives the number of turns that 90 % of alike bearings reach before the first spall,
``L10 = a_iso (C / P)^p 10^6``, with ``p = 3`` for balls and ``10/3`` for rollers. Single lives have a Weibull distribution with the slope
10/9 for balls and 9/8 for rollers [2]_, on which the ratings ``C`` are based.

.. [1] ISO 281:2007, Rolling bearings - Dynamic load ratings and rating life.
.. [2] G. Lundberg, A. Palmgren, "Dynamic capacity of rolling bearings", Acta Polytechnica, Mech. Eng. Ser. 1 (1947) no. 3; "... of roller
   bearings", ibid. 2 (1952) no. 4.
"""

import math
from typing import Literal

Element = Literal["ball", "roller"]

EXPONENT = {"ball": 3.0, "roller": 10 / 3}
SLOPE = {"ball": 10 / 9, "roller": 9 / 8}
HIGHEST_RATIO = 0.5
"""Largest load over the dynamic rating for which ISO 281 holds [1]."""
MILLION = 1e6
_OF_TENTH = -math.log(0.9)


def rating_life(load_ratio: float, element: Element, factor: float = 1.0) -> float:
    """Turns that nine of ten bearings reach [1]; ``load_ratio`` is the equivalent load over the dynamic rating, ``factor`` is a_iso.

    >>> round(rating_life(0.1, "ball") / 1e6)
    1000
    """
    return factor * load_ratio ** -EXPONENT[element] * MILLION


def life_share(failed: float, element: Element) -> float:
    """Life that a share ``failed`` of alike bearings does not reach, over the rating life [1].

    >>> round(life_share(0.1, "ball"), 2), round(life_share(0.5, "ball"), 2)
    (1.0, 5.45)
    """
    return (-math.log1p(-failed) / _OF_TENTH) ** (1 / SLOPE[element])
