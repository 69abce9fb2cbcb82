"""Recipes: YAML files, read into a frozen model.

============= ==============================================================
module        responsibility
============= ==============================================================
machine       bearing, machine, lubricant, specimen
faults        entries of faults: one kind, several at once, or none
life          life of the bearings, snapshots, end of a test
operation     speed and load with their profiles, slip, temperature
sensing       sensors, level, converter
changes       keys of operation and level that one fault replaces
fault_entries keys that all entries of faults have in common
origin        where the record of a drawn recipe comes from
sections      all sections of a recipe, and the counts that follow from them
shares        quantities that are a share of another
life_checks   lives that cannot be
loads         loads that no bearing of the recipe can carry
checks        keys that contradict each other, weights that cannot be met
model         the checked recipe
constructors  faults and distributions by calls in Python
keywords      a recipe from keys by their own names
yaml_text     a recipe as YAML text
keys          every key with unit, range, default and meaning
finding       paths and names of recipe files
reading       a file read into the model, its hash
editor_schema JSON schema of a recipe, for editors
============= ==============================================================
"""

import lazy_loader

# a name or a path of a recipe is looked up without the model of recipes
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
