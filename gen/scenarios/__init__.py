"""Scenarios: a recipe, fully drawn, nothing random left but what happens in time.

====== ============================================================
module responsibility
====== ============================================================
model  rigs, specimens, records, and the random streams they own
draw   how each is drawn, level by level
====== ============================================================
"""

from gen.scenarios.draw import draw_scenarios, fault_of_each_specimen
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
    "stream",
]
