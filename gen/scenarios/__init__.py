"""Scenarios: rigs, specimens and records with every value drawn; only the course of random processes in time is left to the simulation.

====== ============================================================
module responsibility
====== ============================================================
model  rigs, specimens, records, and the random streams they own
draws  values drawn one after the other, from the distributions
faults which specimens are damaged, and how
draw   how each is drawn, level by level
stored scenarios as the text that a corpus stores, and back
====== ============================================================
"""

from gen.scenarios.draw import draw_scenarios
from gen.scenarios.faults import fault_of_each_specimen, first_specimens
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
    "first_specimens",
    "read_scenario",
    "scenario_texts",
    "stream",
]
