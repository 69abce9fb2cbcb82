from .editor_schema import recipe_schema as recipe_schema
from .faults import Fault as Fault, class_of as class_of
from .finding import find_recipe as find_recipe, recipe_purpose as recipe_purpose, shipped_recipes as shipped_recipes
from .keywords import make_recipe as make_recipe
from .machine import CatalogueBearing as CatalogueBearing
from .model import Recipe as Recipe
from .origin import OriginSection as OriginSection, Snapshot as Snapshot
from .reading import (
    corpus_identity as corpus_identity,
    read_recipe as read_recipe,
    recipe_hash as recipe_hash,
)
from .sensing import MAX_OVERSAMPLING as MAX_OVERSAMPLING
from .shares import (
    FREE_ANGLE as FREE_ANGLE,
    LEAST_AXIAL_LOAD as LEAST_AXIAL_LOAD,
    STATIC_RATING as STATIC_RATING,
    ranges as ranges,
)
from .yaml_text import recipe_text as recipe_text, write_recipe as write_recipe
