"""Draw the values of one rig, specimen or record, one after the other."""

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from gen.recipe import Section
from gen.recipe.distributions import Grid
from gen.scenarios.model import Drawn
from gen.units import split_unit

_unit_of = functools.cache(split_unit)


class Draws:
    """Source of the values of one rig, specimen or record.

    The first values come from the coordinates of a quasi-random ``point``, further ones from ``rng``. A grid takes its value by the
    ``number`` of the item; several grids enumerate all combinations.
    """

    def __init__(self, rng: np.random.Generator, point: NDArray[np.float64], number: int) -> None:
        self._rng = rng
        self._point = list(point[::-1])
        self._combination = number

    def u(self) -> float:
        """Next number in [0, 1)."""
        return float(self._point.pop()) if self._point else float(self._rng.random())

    def value(self, distribution: Any) -> float:
        """Next value of a distribution, in the unit of the recipe key."""
        u = self.u()
        if isinstance(distribution, Grid):
            self._combination, position = divmod(self._combination, len(distribution.values))
            return float(distribution.values[position])
        return distribution.draw(u)

    def section(self, section: Section) -> Drawn:
        """One value of every distribution of a section, in SI units, by the key without its unit."""
        drawn: Drawn = {}
        for key, distribution in section:
            if isinstance(distribution, BaseModel) and hasattr(distribution, "draw"):
                name, factor = _unit_of(key)
                drawn[name] = self.value(distribution) * factor
        return drawn

    def is_present(self, section: Any) -> bool:
        """True with the probability that a section gives."""
        return self.u() < section.probability
