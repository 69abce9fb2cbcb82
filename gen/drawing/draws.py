"""Numbers from which the values of one rig, specimen or record are drawn: by name, from a quasi-random point, or from grids."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, NamedTuple

from gen.drawing.distributions import Grid, interval, is_within
from gen.drawing.streams import Level, number
from gen.support.errors import RecipeError
from gen.support.units import split_unit

Derived = Callable[[Callable[[str], float]], float]
"""Value of a derived quantity, from a function that gives the values of the section by key [SI]."""
Wholes = Mapping[str, float | Derived]
"""Quantities by key [SI] that those of a section can be a share of, beside each other."""


@dataclass(slots=True)
class Combination:
    """Place of an item in the combinations of the grids of its level: the first grid takes the fastest part of ``number``."""

    number: int
    """Of the combinations of the grids to come."""

    def next(self, grid: Grid) -> float:
        """Value of the next grid."""
        self.number, position = divmod(self.number, len(grid.values))
        return float(grid.values[position])


class Draws(NamedTuple):
    """Numbers of one rig, specimen or record, for one section of its recipe."""

    seed: int
    level: Level
    of: int
    """Number of the rig, specimen or record."""
    grids: Combination
    point: list[float]
    """Coordinates of a quasi-random point that are left, last first: the first numbers come from it."""
    wholes: Wholes = MappingProxyType({})
    own: Level = "rig"
    """Level of the section around this one."""
    place: str = ""
    """Path of the section, with which the names of its numbers begin."""
    channels: int = 1
    """Number of channels of a record."""
    bearing: Any = None
    """Bearing of a specimen, for what is drawn on it."""
    attempt: int = 0
    """How many draws before this one were given up."""

    def u(self, name: str) -> float:
        """Number in [0, 1) of a key or another name of the section."""
        if self.point:
            return self.point.pop()
        tries = f" try {self.attempt}" if self.attempt else ""
        return number(self.seed, self.level, self.of, f"{self.place}{name}{tries}")

    def value(self, key: str, distribution: Any) -> float:
        """Value of a distribution in the unit of its key; of a share, the share."""
        if distribution.kind == "constant" and not self.point:
            return distribution.value  # the same for every number
        u = self.u(key)  # of a grid too: to make one of a distribution moves no other value of a quasi-random point
        return self.grids.next(distribution) if distribution.kind == "grid" else distribution.draw(u)

    def values(self, key: str, distribution: Any, count: int) -> tuple[float, ...]:
        """Value of a distribution for each of ``count`` items."""
        if distribution.kind == "listed":
            return distribution.values
        return tuple(self.value(f"{key}.{item}", distribution) for item in range(count))

    def within(self, key: str, own: Level, wholes: Wholes | None = None) -> "Draws":
        """Numbers of a section within this one, which is of the level ``own``."""
        wholes = self.wholes if wholes is None else wholes
        # _replace takes three times as long
        return Draws(*self[:5], wholes, own, f"{self.place}{key}.", *self[8:])

    def with_shares(
        self, bounds_of: Mapping[str, Any], numbers: Mapping[str, Any], shares: Mapping[str, str]
    ) -> dict[str, Any]:
        """Drawn ``numbers`` in the units of their keys, each of the ``shares`` times the quantity that it names.

        Raises
        ------
        RecipeError
            If the value of a share is outside the bounds of its key.
        """

        def in_si(key: str, item: int = 0) -> float:
            """Value of a quantity; of one that is drawn for each item, that of an item."""
            if key not in numbers:
                whole = self.wholes[key]
                return whole(in_si) if callable(whole) else whole
            number = numbers[key][item] if isinstance(numbers[key], tuple) else numbers[key]
            return number * (in_si(shares[key], item) if key in shares else split_unit(key)[1])

        def product(key: str, share: float, item: int = 0) -> float:
            """Value of a share, within the range of its key up to rounding."""
            bounds, value = bounds_of[key], share * in_si(shares[key], item) / split_unit(key)[1]
            if is_within(value, bounds):
                return value
            if not is_within(value, bounds, rounding=1e-9):
                raise RecipeError(
                    f"{self.level} {self.of}: {key}: a share of {share:.4g} of {shares[key]} gives {value:.4g}, which is not in "
                    f"{interval(bounds)}; change the range of the share."
                )
            return min(max(value, bounds["low"]), bounds["high"])

        # shares are multiplied in SI units, since the quantity may have another unit
        drawn = dict(numbers)
        for key in shares:
            value = numbers[key]
            if isinstance(value, tuple):
                drawn[key] = tuple(product(key, share, item) for item, share in enumerate(value))
            else:
                drawn[key] = product(key, value)
        return drawn
