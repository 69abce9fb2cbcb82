"""Values of one rig, specimen or record, drawn one after the other."""

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
    """Values of one rig, specimen or record, drawn one after the other.

    The first come from a quasi-random point if there is one; grids follow the number of the item.
    """

    def __init__(self, rng: np.random.Generator, point: NDArray[np.float64], turn: int) -> None:
        self._rng = rng
        self._point = list(point[::-1])
        self._turn = turn

    def u(self) -> float:
        """Next number in [0, 1)."""
        return float(self._point.pop()) if self._point else float(self._rng.random())

    def value(self, distribution: Any) -> float:
        """Value of a distribution in its own unit."""
        u = self.u()
        if isinstance(distribution, Grid):
            self._turn, place = divmod(self._turn, len(distribution.values))
            return float(distribution.values[place])
        return distribution.draw(u)

    def section(self, section: Section) -> Drawn:
        """Every distribution of a section, in SI units, by its key without the unit."""
        drawn: Drawn = {}
        for key, distribution in section:
            if isinstance(distribution, BaseModel) and hasattr(distribution, "draw"):
                name, factor = _unit_of(key)
                drawn[name] = self.value(distribution) * factor
        return drawn

    def happens(self, section: Any) -> bool:
        """Whether something with a probability is there."""
        return self.u() < section.probability
