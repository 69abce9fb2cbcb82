"""From a recipe to a corpus of labelled bearing vibration.

``recipe.yaml -> read_recipe -> Recipe -> draw_scenarios -> [Scenario] -> simulate -> Response -> measure -> records -> corpus``

=========== ==================================================================
module      responsibility
=========== ==================================================================
errors      what can go wrong, one sentence each
limits      how much a file from elsewhere may ask for
units       units of recipes and mapping files, turned into SI
cluster     independent tasks on dask
plain_files files opened only if they are no pipes or devices
yaml_files  recipes and mapping files, read within the limits
physics     pure: bearing, Hertz contact, spalls, machine, kernel
corpus      the netCDF format: write, index, open, validate
importers   real recordings into the same format
recipe      YAML to a frozen model
scenarios   rigs, specimens and records, fully drawn
simulation  scenarios to accelerations
measurement accelerations to what a data-acquisition card stores
labels      what is written beside each record
generate    a corpus, part by part, with dask
replay      any record again, bit for bit
plan        what a recipe would make, without making it
pages       documentation pages written from the code
=========== ==================================================================

Data flows down this list; a module imports only modules above it.
"""

from gen.corpus import open_corpus, validate_corpus
from gen.errors import ClusterError, CorpusError, RacewayError, RecipeError, SimulationError
from gen.generate import generate
from gen.recipe import read_recipe
from gen.replay import replay
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate

__all__ = [
    "ClusterError",
    "CorpusError",
    "RacewayError",
    "RecipeError",
    "SimulationError",
    "draw_scenarios",
    "generate",
    "open_corpus",
    "read_recipe",
    "replay",
    "simulate",
    "validate_corpus",
]
