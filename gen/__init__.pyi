from .corpus import (
    Publication as Publication,
)
from .corpus import (
    open_corpus as open_corpus,
)
from .corpus import (
    publish as publish,
)
from .corpus import (
    read_publication as read_publication,
)
from .corpus import (
    validate_corpus as validate_corpus,
)
from .exporting import copy as copy
from .exporting import torch_dataset as torch_dataset
from .generation.corpus import generate as generate
from .generation.memory import (
    recipe_of as recipe_of,
)
from .generation.memory import (
    record as record,
)
from .generation.memory import (
    records as records,
)
from .generation.memory import (
    scenarios_of as scenarios_of,
)
from .generation.memory import (
    simulate_scenarios as simulate_scenarios,
)
from .generation.replaying import replay as replay
from .generation.replaying import shaft_angles as shaft_angles
from .generation.replaying import stored_scenario as stored_scenario
from .generation.writing import write_corpus as write_corpus
from .recipe import (
    Recipe as Recipe,
)
from .recipe import (
    ball as ball,
)
from .recipe import (
    cage as cage,
)
from .recipe import (
    choice as choice,
)
from .recipe import (
    compound as compound,
)
from .recipe import (
    distributed as distributed,
)
from .recipe import (
    grid as grid,
)
from .recipe import (
    healthy as healthy,
)
from .recipe import (
    inner as inner,
)
from .recipe import (
    loguniform as loguniform,
)
from .recipe import (
    normal as normal,
)
from .recipe import (
    outer as outer,
)
from .recipe import (
    read_recipe as read_recipe,
)
from .recipe import (
    recipe_for as recipe_for,
)
from .recipe import (
    uniform as uniform,
)
from .recipe import (
    write_recipe as write_recipe,
)
from .scenarios import draw_scenarios as draw_scenarios
from .simulation.simulate import simulate as simulate
from .support.errors import (
    ClusterError as ClusterError,
)
from .support.errors import (
    CorpusError as CorpusError,
)
from .support.errors import (
    RacewayError as RacewayError,
)
from .support.errors import (
    RecipeError as RecipeError,
)
from .support.errors import (
    SimulationError as SimulationError,
)
