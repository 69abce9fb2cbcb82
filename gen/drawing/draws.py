"""Draw the values of one rig, specimen or record, one after the other.

A quantity that is a share of another takes its random number in its turn, like any other; the product is taken when all quantities of the
section are drawn.
"""

import functools
import math
import reprlib
from collections.abc import Callable, Collection, Mapping
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator

from gen.drawing.distributions import Grid, interval, is_within
from gen.drawing.section import Section, quantities
from gen.support.errors import RecipeError
from gen.support.units import decibel_to_ratio, split_unit


def drawn_values(value: Any) -> Any:
    """Drawn values that may come from a file, lists as tuples; ValueError about one that is neither a number nor a drawn section."""
    if isinstance(value, dict):
        return {key: item if key == "kind" else drawn_values(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return tuple(map(drawn_values, value))
    if value is None or type(value) in (int, float):
        return value
    raise ValueError(f"{reprlib.repr(value)} is no number")


Drawn = Annotated[dict[str, Any], AfterValidator(drawn_values)]
"""Values drawn from one recipe section, by the key without its unit: numbers, and drawn sections within it."""
Derived = Callable[[Callable[[str], float]], float]
"""Value of a derived quantity, from a function that gives the values of the section by key [SI]."""
Known = Mapping[str, float | Derived]
"""Quantities by key [SI] that those of a section can be a share of, beside each other."""

_NO_POINT = np.empty(0)
_unit_of = functools.cache(split_unit)


class Combination:
    """Place of an item in the combinations of the grids of its level: the first grid takes the fastest part of ``number``."""

    def __init__(self, number: int) -> None:
        self.number = number
        """Of the combinations of the grids to come."""

    def value(self, distribution: Any, u: float) -> float:
        """Value of a distribution at the quantile ``u``, in the unit of its key; of a grid, the next one of the combination."""
        if isinstance(distribution, Grid):
            self.number, position = divmod(self.number, len(distribution.values))
            return float(distribution.values[position])
        return distribution.draw(u)


class Draws:
    """Source of the values of one rig, specimen or record.

    The first values come from the coordinates of a quasi-random ``point``, further ones from ``rng``. A grid takes its value by the
    ``number`` of the item; several grids enumerate all combinations. Errors name the ``item``, such as ``specimen 3``.
    """

    def __init__(
        self, rng: np.random.Generator, number: int, item: str, point: NDArray[np.float64] = _NO_POINT
    ) -> None:
        self.item = item
        self._rng = rng
        self._point = list(point[::-1])
        self.combination = Combination(number)

    def u(self) -> float:
        """Next number in [0, 1)."""
        return float(self._point.pop()) if self._point else float(self._rng.random())

    def spawn(self, count: int) -> "list[Draws]":
        """Draws of the parts of the item, each from a stream of its own."""
        return [Draws(rng, self.combination.number, self.item) for rng in self._rng.spawn(count)]

    def value(self, distribution: Any) -> float:
        """Next value of a distribution, in the unit of the recipe key; of a share, the share."""
        return self.combination.value(distribution, self.u())

    def ratio(self, level: Any) -> float:
        """Next value of the distribution of a level in decibels, as a ratio of amplitudes [1]."""
        return decibel_to_ratio(self.value(level))

    def angle(self) -> float:
        """Next angle, anywhere in a turn [rad]."""
        return 2 * math.pi * self.u()

    def section(self, section: Section, known: Known | None = None, keys: Collection[str] | None = None) -> Drawn:
        """One value of every distribution of a section, or of some ``keys`` of it, in SI units, by the key without its unit.

        Raises
        ------
        RecipeError
            If a share of a ``known`` quantity is outside the range of its key.
        """
        distributions = {
            key: distribution for key, distribution in quantities(section).items() if keys is None or key in keys
        }
        numbers = {key: self.value(distribution) for key, distribution in distributions.items()}
        return in_si(section, distributions, numbers, known or {}, self.item)

    def is_present(self, section: Any) -> bool:
        """True with the probability that a section gives."""
        return self.u() < section.probability


def in_si(
    section: Section, distributions: Mapping[str, Any], numbers: Mapping[str, float], known: Known, item: str
) -> Drawn:
    """Drawn ``numbers`` of a section of an ``item`` in SI units, by the key without its unit.

    Each share is multiplied by the quantity that it is a share of, of the section or ``known``.

    Raises
    ------
    RecipeError
        If the value of a share is outside the range of its key.
    """

    def value(key: str) -> float:
        if key not in numbers:
            whole = known[key]
            return whole(value) if callable(whole) else whole
        named = distributions[key].share_of
        if named is None:
            return numbers[key] * _unit_of(key)[1]
        product = numbers[key] * value(named)
        _check_share(section, key, product, f"{item}: {key}: a share of {numbers[key]:.4g} of {named}")
        return product

    return {_unit_of(key)[0]: value(key) for key in numbers}


def _check_share(section: Section, key: str, value: float, share: str) -> None:
    bounds: Any = type(section).model_fields[key].json_schema_extra
    in_unit = value / _unit_of(key)[1]
    if not any(is_within(in_unit * rounding, bounds) for rounding in (1, 1 - 1e-9, 1 + 1e-9)):
        raise RecipeError(
            f"{share} gives {in_unit:.4g}, which is not in {interval(bounds)}; change the range of the share."
        )


def known_of(section: Section, drawn: Drawn) -> dict[str, float]:
    """Drawn values of a section by the keys of the recipe [SI]."""
    return {key: drawn[_unit_of(key)[0]] for key in quantities(section)}
