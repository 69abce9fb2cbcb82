from .constructors import (
    ball as ball,
)
from .constructors import (
    cage as cage,
)
from .constructors import (
    choice as choice,
)
from .constructors import (
    compound as compound,
)
from .constructors import (
    distributed as distributed,
)
from .constructors import (
    grid as grid,
)
from .constructors import (
    healthy as healthy,
)
from .constructors import (
    inner as inner,
)
from .constructors import (
    loguniform as loguniform,
)
from .constructors import (
    normal as normal,
)
from .constructors import (
    outer as outer,
)
from .constructors import (
    uniform as uniform,
)
from .faults import (
    BallFault as BallFault,
)
from .faults import (
    CageFault as CageFault,
)
from .faults import (
    CompoundFault as CompoundFault,
)
from .faults import (
    DistributedFault as DistributedFault,
)
from .faults import (
    Fault as Fault,
)
from .faults import (
    Healthy as Healthy,
)
from .faults import (
    RaceFault as RaceFault,
)
from .faults import (
    fault_class as fault_class,
)
from .finding import find_recipe as find_recipe
from .finding import recipe_purpose as recipe_purpose
from .finding import shipped_recipes as shipped_recipes
from .keywords import recipe_for as recipe_for
from .machine import CatalogueBearing as CatalogueBearing
from .model import Recipe as Recipe
from .operation import ProfileSection as ProfileSection
from .reading import (
    corpus_identity as corpus_identity,
)
from .reading import (
    read_recipe as read_recipe,
)
from .reading import (
    recipe_hash as recipe_hash,
)
from .reading import (
    recipe_schema as recipe_schema,
)
from .section import Section as Section
from .section import plain as plain
from .sensing import (
    MAX_OVERSAMPLING as MAX_OVERSAMPLING,
)
from .sensing import (
    Modes as Modes,
)
from .sensing import (
    Modulation as Modulation,
)
from .sensing import (
    PathSection as PathSection,
)
from .shares import (
    BALL_SPACING as BALL_SPACING,
)
from .shares import (
    FREE_ANGLE as FREE_ANGLE,
)
from .shares import (
    LEAST_AXIAL_LOAD as LEAST_AXIAL_LOAD,
)
from .shares import (
    STATIC_RATING as STATIC_RATING,
)
from .shares import (
    operations as operations,
)
from .shares import (
    quantities as quantities,
)
from .text import recipe_text as recipe_text
from .text import write_recipe as write_recipe
