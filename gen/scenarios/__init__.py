"""Scenarios: a recipe, fully drawn, nothing random left but what happens in time.

====== ============================================================
module responsibility
====== ============================================================
model  rigs, specimens, records, and the random streams they own
draws  values drawn one after the other, from a recipe's distributions
faults which specimens are damaged, and how
draw   how each is drawn, level by level
====== ============================================================
"""

from gen.scenarios.draw import draw_scenarios
from gen.scenarios.faults import fault_of_each_specimen, first_specimens
from gen.scenarios.model import (
    Background,
    Mode,
    Operation,
    Path,
    Purpose,
    Rig,
    Scenario,
    Spall,
    Specimen,
    Tone,
    Wear,
    stream,
)

__all__ = [
    "Background",
    "Mode",
    "Operation",
    "Path",
    "Purpose",
    "Rig",
    "Scenario",
    "Spall",
    "Specimen",
    "Tone",
    "Wear",
    "draw_scenarios",
    "fault_of_each_specimen",
    "first_specimens",
    "stream",
]
