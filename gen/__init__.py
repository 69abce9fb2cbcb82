"""From a recipe to a corpus of labelled bearing vibration.

``recipe.yaml -> read_recipe -> Recipe -> draw_scenarios -> [Scenario] -> simulate -> Response -> measure -> records -> corpus``

=========== ==================================================================
module      responsibility
=========== ==================================================================
errors      one exception class per stage; each carries one sentence
lazy        public names that are imported when they are first used
progress    progress of a long call
limits      how much a file from elsewhere may ask for
units       units of recipes and mapping files, turned into SI
cluster     independent tasks on dask
workers     independent tasks in this thread, threads, processes or a cluster
sources     hash of the source files that make records
yaml_files  recipes and mapping files, read within the limits
sentences   an error sentence for each wrong key or value of these files
physics     pure: bearing, Hertz contact, spalls, machine, kernel
corpus      the netCDF format: write, index, open, validate
exporting   corpora copied, joined, in the forms of other programs
importers   real recordings into the same format
recipe      YAML to a frozen model
scenarios   rigs, specimens and records, fully drawn
simulation  scenarios to accelerations
measurement accelerations to stored counts, as a data-acquisition card gives
labels      variables written beside each record
pace        seconds that some records take on this machine
families    records drawn, simulated and measured; faults that cannot be seen drawn again
checking    some records integrated again at half their step
making      records of several parts made together, so that batches are full
part_task   parts labelled and written
compilation kernels of a recipe compiled before its first record
generation  a corpus, part by part, with dask
replaying   any record made again from the scenario that it stores, bit for bit
in_memory   records as one Dataset, from keys or from scenarios made by hand
plan        counts, size and steps of a corpus before it is made
pages       documentation pages written from the code
writing     a Dataset of records as a corpus
=========== ==================================================================

Data flows down this list; a module imports only modules above it. Public names are imported when they are first used, so that
opening a corpus loads neither numba nor distributed. No public name is the name of a module: importing a module would replace it.
"""

from typing import TYPE_CHECKING

from gen.errors import ClusterError, CorpusError, RacewayError, RecipeError, SimulationError
from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.corpus import Publication, open_corpus, publish, read_publication, validate_corpus
    from gen.exporting import copy, torch_dataset
    from gen.generation import generate
    from gen.in_memory import recipe_of, record, records, scenarios_of, simulate_scenarios
    from gen.recipe import (
        Recipe,
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
        read_recipe,
        recipe_for,
        uniform,
        write_recipe,
    )
    from gen.replaying import replay, shaft_angles, stored_scenario
    from gen.scenarios import draw_scenarios
    from gen.simulation.simulate import simulate
    from gen.writing import write_corpus

__all__ = [
    "ClusterError",
    "CorpusError",
    "Publication",
    "RacewayError",
    "Recipe",
    "RecipeError",
    "SimulationError",
    "ball",
    "cage",
    "choice",
    "compound",
    "copy",
    "distributed",
    "draw_scenarios",
    "generate",
    "grid",
    "healthy",
    "inner",
    "loguniform",
    "normal",
    "open_corpus",
    "outer",
    "publish",
    "read_publication",
    "read_recipe",
    "recipe_for",
    "recipe_of",
    "record",
    "records",
    "replay",
    "scenarios_of",
    "shaft_angles",
    "simulate",
    "simulate_scenarios",
    "stored_scenario",
    "torch_dataset",
    "uniform",
    "validate_corpus",
    "write_corpus",
    "write_recipe",
]

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "gen.corpus": ("Publication", "open_corpus", "publish", "read_publication", "validate_corpus"),
        "gen.exporting": ("copy", "torch_dataset"),
        "gen.generation": ("generate",),
        "gen.in_memory": ("recipe_of", "record", "records", "scenarios_of", "simulate_scenarios"),
        "gen.recipe": (
            "Recipe", "ball", "cage", "choice", "compound", "distributed", "grid", "healthy", "inner", "loguniform", "normal", "outer",
            "read_recipe", "recipe_for", "uniform", "write_recipe",
        ),
        "gen.replaying": ("replay", "shaft_angles", "stored_scenario"),
        "gen.scenarios": ("draw_scenarios",),
        "gen.simulation.simulate": ("simulate",),
        "gen.writing": ("write_corpus",),
    },
)  # fmt: skip
