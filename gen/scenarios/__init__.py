"""Scenarios: recipes with every value drawn, one for each record; the simulation draws only what is random in time.

========= =================================================================
module    responsibility
========= =================================================================
scenario  the recipe of one record, and what follows from it
points    quasi-random points
classes   choose the fault class of each specimen
lives     lives of the bearings, and records as snapshots of them
draw      draw rigs, specimens and records
variables variables of a corpus that a scenario tells
stored    write scenarios as the texts that a corpus stores, and read them
========= =================================================================
"""

from gen.scenarios.classes import fault_of_each_specimen, first_records
from gen.scenarios.draw import draw_scenarios, further_ratios, split_of
from gen.scenarios.scenario import Scenario, same_recording, scenario_of
from gen.scenarios.stored import read_scenario, read_scenarios, scenario_texts

__all__ = [
    "Scenario",
    "draw_scenarios",
    "fault_of_each_specimen",
    "first_records",
    "further_ratios",
    "read_scenario",
    "read_scenarios",
    "same_recording",
    "scenario_of",
    "scenario_texts",
    "split_of",
]
