"""From a recipe to a corpus of labelled bearing vibration.

``recipe.yaml -> read_recipe -> Recipe -> draw_scenarios -> [Scenario] -> simulate -> [Run] -> measure -> records -> corpus``

=========== ==================================================================
module      responsibility
=========== ==================================================================
support     errors, limits, units, YAML, progress, tasks on cores and clusters
physics     pure: bearing, Hertz contact, spalls, machine, kernel
life        pure: when a spall begins, how it grows until the end
corpus      the netCDF format: write, index, open, validate
drawing     what a recipe is made of: distributions, sections, draws
mechanisms  what happens in a machine and its measuring chain, one file each
recipe      YAML to a frozen model
scenarios   rigs, specimens and records, fully drawn
simulation  scenarios to accelerations
measurement accelerations to stored counts, as a data-acquisition card gives
generation  a recipe to a corpus, to records in memory, or to a plan
format_page the page about the format, from its schema
pages       documentation pages written from the code
=========== ==================================================================

Data flows down this list; a module imports only modules above it. Public names are imported when they are first used, so that
opening a corpus loads neither numba nor distributed. No public name is the name of a module: importing a module would replace it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
