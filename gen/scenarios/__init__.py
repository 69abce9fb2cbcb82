"""Scenarios: rigs, specimens and records with every value drawn; the simulation draws only the random processes in time.

========= ===================================================================
module    responsibility
========= ===================================================================
model     dataclasses of rig, specimen and record; random streams
points    quasi-random points
draws     draw values from the distributions of a recipe section
classes   choose the fault class of each specimen
faults    draw the damage of a specimen
operating operating conditions: per rig, specimen or record, shares, changes
records   records of a specimen, with rungs of severity
draw      draw rigs and specimens, and with them all records
stored    write a scenario as the JSON text that a corpus stores, and read it
========= ===================================================================
"""

from gen.scenarios.classes import fault_of_each_specimen, first_records, first_specimens
from gen.scenarios.draw import draw_scenarios
from gen.scenarios.model import (
    Background,
    Mode,
    Operation,
    Path,
    Pickup,
    Purpose,
    Rig,
    Scenario,
    ShaftModulation,
    Spall,
    Specimen,
    Tone,
    Wear,
    stream,
)
from gen.scenarios.stored import read_scenario, scenario_texts

__all__ = [
    "Background",
    "Mode",
    "Operation",
    "Path",
    "Pickup",
    "Purpose",
    "Rig",
    "Scenario",
    "ShaftModulation",
    "Spall",
    "Specimen",
    "Tone",
    "Wear",
    "draw_scenarios",
    "fault_of_each_specimen",
    "first_records",
    "first_specimens",
    "read_scenario",
    "scenario_texts",
    "stream",
]
