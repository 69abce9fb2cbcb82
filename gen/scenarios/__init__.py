"""Scenarios: rigs, specimens and records with every value drawn; the simulation draws only the random processes in time.

============= =================================================================
module        responsibility
============= =================================================================
model         dataclasses of rig, specimen and record; random streams
points        quasi-random points
bearings      draw the bearing of a rig, and its deviations as built
classes       choose the fault class of each specimen
operating     operating conditions: per rig, specimen or record, shares, changes
lives         lives of the bearings, and records as snapshots of them
records       records of a specimen, with rungs of severity
draw          draw rigs and specimens, and with them all records
settings      values that a recipe fixes for all of its records
checks        check a scenario that was changed by hand, or comes from a file
variables     variables of a corpus that a scenario tells
stored        write scenarios as the JSON texts that a corpus stores, and read them
============= =================================================================
"""

from gen.scenarios.checks import check_scenario, simulation_errors
from gen.scenarios.classes import fault_of_each_specimen, first_records, first_specimens
from gen.scenarios.draw import draw_scenarios
from gen.scenarios.model import (
    Gains,
    Operation,
    Pickup,
    Purpose,
    Rig,
    Scenario,
    Settings,
    Snapshot,
    Specimen,
    stream,
)
from gen.scenarios.records import further_ratios
from gen.scenarios.settings import common_settings, settings_of
from gen.scenarios.stored import read_scenario, read_scenarios, scenario_texts

__all__ = [
    "Gains",
    "Operation",
    "Pickup",
    "Purpose",
    "Rig",
    "Scenario",
    "Settings",
    "Snapshot",
    "Specimen",
    "check_scenario",
    "common_settings",
    "draw_scenarios",
    "fault_of_each_specimen",
    "first_records",
    "first_specimens",
    "further_ratios",
    "read_scenario",
    "read_scenarios",
    "scenario_texts",
    "settings_of",
    "simulation_errors",
    "stream",
]
