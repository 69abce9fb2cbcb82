"""The recipe: YAML in, a frozen model out.

============= ========================================================
module        responsibility
============= ========================================================
distributions what a recipe may draw from
section       what every part shares: units, bounds, known keys
machine       bearing, machine, lubricant, specimen
faults        spalls, worn races, broken cages, several at once
operation     speed and load with their profiles, slip, temperature
sensing       sensors, path, background, level, converter
loads         loads that no bearing of the recipe can carry
model         the recipe as a whole
reading       files, names, error sentences, hash and JSON schema
============= ========================================================
"""

from gen.recipe.faults import (
    BallFault,
    CageFault,
    CompoundFault,
    DistributedFault,
    Fault,
    Healthy,
    RaceFault,
    fault_class,
)
from gen.recipe.machine import CatalogueBearing
from gen.recipe.model import Recipe
from gen.recipe.operation import Profile
from gen.recipe.reading import find_recipe, read_recipe, recipe_hash, recipe_purpose, recipe_schema, shipped_recipes
from gen.recipe.section import Section, split_unit
from gen.recipe.sensing import MAX_OVERSAMPLING, Channel, Modes, Modulation, Path

__all__ = [
    "MAX_OVERSAMPLING",
    "BallFault",
    "CageFault",
    "CatalogueBearing",
    "Channel",
    "CompoundFault",
    "DistributedFault",
    "Fault",
    "Healthy",
    "Modes",
    "Modulation",
    "Path",
    "Profile",
    "RaceFault",
    "Recipe",
    "Section",
    "fault_class",
    "find_recipe",
    "read_recipe",
    "recipe_hash",
    "recipe_purpose",
    "recipe_schema",
    "shipped_recipes",
    "split_unit",
]
