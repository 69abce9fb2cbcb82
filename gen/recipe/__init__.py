"""Recipes: YAML files, read into a frozen model.

============= ========================================================
module        responsibility
============= ========================================================
expressions   distributions as text: loguniform(0.1, 2)
distributions distributions of drawn values
section       base of all sections: bounds, unknown keys, meanings
machine       bearing, machine, lubricant, specimen
faults        spalls, worn races, broken cages, several at once
operation     speed and load with their profiles, slip, temperature
publication   licence, creators and references of the corpus
gear          gear mesh in the background
sensing       sensors, path, background, level, converter
sensor_faults faults of mount, cable, amplifier and data transfer
changes       keys of operation and level that one fault replaces
fault_entries keys that all entries of faults have in common
shares        quantities that are a share of another
loads         loads that no bearing of the recipe can carry
checks        keys that contradict each other, weights that cannot be met
model         the recipe as a whole
constructors  faults and distributions by calls in Python
keywords      a recipe from keys by their own names
text          a recipe as YAML text
keys          every key with unit, range, default and meaning
finding       paths and names of recipe files
reading       a file read into the model, its hash, JSON schema
============= ========================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.recipe.constructors import (
        ball,
        cage,
        choice,
        compound,
        distributed,
        grid,
        healthy,
        inner,
        loguniform,
        normal,
        outer,
        uniform,
    )
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
    from gen.recipe.finding import find_recipe, recipe_purpose, shipped_recipes
    from gen.recipe.keywords import recipe_for
    from gen.recipe.machine import CatalogueBearing
    from gen.recipe.model import Recipe
    from gen.recipe.operation import ProfileSection
    from gen.recipe.reading import corpus_identity, read_recipe, recipe_hash, recipe_schema
    from gen.recipe.section import Section, plain
    from gen.recipe.sensing import MAX_OVERSAMPLING, Modes, Modulation, PathSection
    from gen.recipe.shares import BALL_SPACING, FREE_ANGLE, LEAST_AXIAL_LOAD, STATIC_RATING, quantities
    from gen.recipe.text import recipe_text, write_recipe

__all__ = [
    "BALL_SPACING",
    "FREE_ANGLE",
    "LEAST_AXIAL_LOAD",
    "MAX_OVERSAMPLING",
    "STATIC_RATING",
    "BallFault",
    "CageFault",
    "CatalogueBearing",
    "CompoundFault",
    "DistributedFault",
    "Fault",
    "Healthy",
    "Modes",
    "Modulation",
    "PathSection",
    "ProfileSection",
    "RaceFault",
    "Recipe",
    "Section",
    "ball",
    "cage",
    "choice",
    "compound",
    "corpus_identity",
    "distributed",
    "fault_class",
    "find_recipe",
    "grid",
    "healthy",
    "inner",
    "loguniform",
    "normal",
    "outer",
    "plain",
    "quantities",
    "read_recipe",
    "recipe_for",
    "recipe_hash",
    "recipe_purpose",
    "recipe_schema",
    "recipe_text",
    "shipped_recipes",
    "uniform",
    "write_recipe",
]

# a name or a path of a recipe is looked up without the model of recipes
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "gen.recipe.constructors": (
            "ball", "cage", "choice", "compound", "distributed", "grid", "healthy", "inner", "loguniform", "normal", "outer", "uniform",
        ),
        "gen.recipe.faults": (
            "BallFault",
            "CageFault",
            "CompoundFault",
            "DistributedFault",
            "Fault",
            "Healthy",
            "RaceFault",
            "fault_class",
        ),
        "gen.recipe.finding": (
            "find_recipe",
            "recipe_purpose",
            "shipped_recipes",
        ),
        "gen.recipe.keywords": ("recipe_for",),
        "gen.recipe.machine": ("CatalogueBearing",),
        "gen.recipe.model": ("Recipe",),
        "gen.recipe.operation": ("ProfileSection",),
        "gen.recipe.reading": (
            "corpus_identity",
            "read_recipe",
            "recipe_hash",
            "recipe_schema",
        ),
        "gen.recipe.section": ("Section", "plain"),
        "gen.recipe.sensing": (
            "MAX_OVERSAMPLING",
            "Modes",
            "Modulation",
            "PathSection",
        ),
        "gen.recipe.shares": (
            "BALL_SPACING",
            "FREE_ANGLE",
            "LEAST_AXIAL_LOAD",
            "STATIC_RATING",
            "quantities",
        ),
        "gen.recipe.text": ("recipe_text", "write_recipe"),
    },
)  # fmt: skip
