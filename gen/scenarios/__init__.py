"""Scenarios: rigs, specimens and records with every value drawn; the simulation draws only the random processes in time.

============= =================================================================
module        responsibility
============= =================================================================
model         dataclasses of rig, specimen and record; random streams
points        quasi-random points
draws         draw values from the distributions of a recipe section
classes       choose the fault class of each specimen
faults        draw the damage of a specimen
sensor_faults draw the faults of the measuring chain, and the gear of a rig
operating     operating conditions: per rig, specimen or record, shares, changes
records       records of a specimen, with rungs of severity
draw          draw rigs and specimens, and with them all records
stored        write a scenario as the JSON text that a corpus stores, and read it
============= =================================================================
"""

from gen.scenarios.classes import fault_of_each_specimen, first_records, first_specimens
from gen.scenarios.draw import draw_scenarios
from gen.scenarios.faults import check_fits
from gen.scenarios.model import (
    Background,
    Gear,
    Mode,
    Operation,
    Path,
    Pickup,
    Purpose,
    RecordSensorFaults,
    Rig,
    RigSensorFaults,
    Scenario,
    ShaftModulation,
    Spall,
    Specimen,
    Tone,
    Wear,
    stream,
)
from gen.scenarios.records import with_level
from gen.scenarios.stored import read_scenario, scenario_texts

__all__ = [
    "Background",
    "Gear",
    "Mode",
    "Operation",
    "Path",
    "Pickup",
    "Purpose",
    "RecordSensorFaults",
    "Rig",
    "RigSensorFaults",
    "Scenario",
    "ShaftModulation",
    "Spall",
    "Specimen",
    "Tone",
    "Wear",
    "check_fits",
    "draw_scenarios",
    "fault_of_each_specimen",
    "first_records",
    "first_specimens",
    "read_scenario",
    "scenario_texts",
    "stream",
    "with_level",
]
