"""The recipe: YAML in, a frozen model out.

========= ========================================================
module    responsibility
========= ========================================================
model     sections, keys, bounds and units of a recipe
reading   files, names, error sentences, hash and JSON schema
reference ``recipes/README.md`` and ``recipes/schema.json``
========= ========================================================
"""

from gen.recipe.model import (
    MAX_OVERSAMPLING,
    BallFault,
    Channel,
    Modes,
    Modulation,
    RaceFault,
    Recipe,
    Section,
    split_unit,
)
from gen.recipe.reading import find_recipe, read_recipe, recipe_hash, recipe_purpose, recipe_schema, shipped_recipes

__all__ = [
    "MAX_OVERSAMPLING",
    "BallFault",
    "Channel",
    "Modes",
    "Modulation",
    "RaceFault",
    "Recipe",
    "Section",
    "find_recipe",
    "read_recipe",
    "recipe_hash",
    "recipe_purpose",
    "recipe_schema",
    "shipped_recipes",
    "split_unit",
]
