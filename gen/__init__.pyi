from .corpus import open_corpus as open_corpus, validate_corpus as validate_corpus
from .corpus.plain_arrays import to_arrays as to_arrays
from .corpus.items import torch_dataset as torch_dataset
from .generation.corpus import generate as generate
from .generation.memory import record as record, records as records, simulate as simulate
from .generation.replaying import replay as replay
from .generation.stream import stream as stream, torch_stream as torch_stream
from .generation.writing import write_corpus as write_corpus
from .physics.bearing_text import bearing_orders as bearing_orders
from .recipe import make_recipe as make_recipe, read_recipe as read_recipe, write_recipe as write_recipe
from .recipe.constructors import (
    ball as ball,
    cage as cage,
    choice as choice,
    compound as compound,
    distributed as distributed,
    grid as grid,
    healthy as healthy,
    inner as inner,
    loguniform as loguniform,
    normal as normal,
    outer as outer,
    uniform as uniform,
)
from .scenarios import draw_scenarios as draw_scenarios, read_scenarios as read_scenarios
from .simulation.shaft import shaft_angles as shaft_angles
from .support.errors import (
    ClusterError as ClusterError,
    CorpusError as CorpusError,
    RacewayError as RacewayError,
    RecipeError as RecipeError,
    SimulationError as SimulationError,
)
