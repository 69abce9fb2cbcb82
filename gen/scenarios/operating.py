"""Draw the operating conditions of a record: values of the record, values of its rig or specimen with scatter, and shares of others.

Every quantity takes one number from the stream of the record and one from those of its specimen and its rig, whether it needs them or
not. So to draw one quantity per rig, to make it a share, or to change it for one fault moves no other.
"""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

import numpy as np

from gen.drawing import Combination, Draws, Known, Section, in_si, quantities
from gen.recipe import Recipe
from gen.scenarios.model import Conditions

Level = Literal["rig", "specimen", "record"]
Distributions = Mapping[str, Any]


class Operating(NamedTuple):
    """Distributions of the operating quantities of a specimen, by key."""

    section: Section
    usual: Mapping[Level, Distributions]
    """Those of ``operation``, by the level at which they are drawn."""
    changes: Mapping[Level, Distributions]
    """Those that the entry of its fault replaces, likewise."""
    wanted: Distributions
    """Those that it has: the usual ones with the changes."""
    levels: Mapping[str, Level]
    """Level at which each quantity is drawn."""


CommonNumbers = tuple[Mapping[str, float], int]
"""Random numbers that all records of a rig, or of a specimen, have in common, one for each operating quantity, and the number of the
combination that the grids of this level begin with."""


def operating_of(recipe: Recipe, number: int) -> Operating:
    """Distributions of the operating quantities of the specimens with the entry ``number`` of ``faults``."""
    usual, entry = quantities(recipe.operation), recipe.faults[number].operation
    changes = {} if entry is None else quantities(entry)
    wanted = {**usual, **changes}
    levels: dict[str, Level] = {key: _level_of(distribution) for key, distribution in wanted.items()}
    return Operating(recipe.operation, _by_level(usual), _by_level(changes), wanted, levels)


def _by_level(distributions: Distributions) -> dict[Level, Distributions]:
    by_level: dict[Level, dict[str, Any]] = {"rig": {}, "specimen": {}, "record": {}}
    for key, distribution in distributions.items():
        by_level[_level_of(distribution)][key] = distribution
    return {**by_level}


def common_numbers(recipe: Recipe, rng: np.random.Generator, combination: int) -> CommonNumbers:
    """Draw the numbers that all records of a rig or a specimen have in common from a stream of that rig or specimen."""
    return {key: float(rng.random()) for key in quantities(recipe.operation)}, combination


def draw_conditions(
    operating: Operating, draws: Draws, commons: Mapping[Level, CommonNumbers], known: Known
) -> Conditions:
    """Operating conditions of a record, without its slip walk.

    ``commons`` has the numbers of rig and specimen, if some quantity is drawn at that level.

    Raises
    ------
    RecipeError
        If a share is outside the range of its key.
    """
    wanted = operating.wanted
    u = {key: draws.u() for key in wanted}
    values = _values(operating, "record", u, draws.combination)
    for level, (numbers, combination) in commons.items():
        for key, value in _values(operating, level, numbers, Combination(combination)).items():
            values[key] = wanted[key].at_scatter(value, u[key])
    return Conditions(**in_si(operating.section, wanted, {key: values[key] for key in wanted}, known, draws.item))


def _values(
    operating: Operating, level: Level, numbers: Mapping[str, float], combination: Combination
) -> dict[str, float]:
    """Values of the quantities that are drawn at a level, in the units of their keys.

    The grids of ``operation`` take their combination first and those of the changes go on from there, so that a change moves no other
    quantity; for the same reason ``combination`` is left as ``operation`` leaves it.
    """
    values: dict[str, float] = {}
    for key, distribution in operating.usual[level].items():
        values[key] = combination.value(distribution, numbers[key])
    further = Combination(combination.number)
    for key, distribution in operating.changes[level].items():
        values[key] = further.value(distribution, numbers[key])
    return {key: value for key, value in values.items() if operating.levels[key] == level}


def _level_of(distribution: Any) -> Level:
    return distribution.per or "record"
