"""Draw the gear and the condition of a machine, each from a random stream of its own: neither moves another drawn value."""

import math

import numpy as np

from gen.drawing.distributions import weighted_index
from gen.drawing.draws import Draws
from gen.recipe import Recipe
from gen.scenarios.model import Purpose, stream
from gen.scenarios.sensing import ConditionSignal, Gear
from gen.support.units import decibel_to_ratio


def draw_gear(recipe: Recipe, rig: int) -> Gear | None:
    """Gear on the shaft of a rig; None if it has none."""
    wanted = recipe.background.gear_mesh
    if wanted is None:
        return None
    draws = Draws(stream(recipe.seed, rig, 0, 0, Purpose.GEAR), np.empty(0), rig, f"rig {rig}")
    if not draws.is_present(wanted):
        return None
    drawn = draws.section(wanted)
    levels = [drawn["level"], *(draws.value(wanted.level_db) for _ in range(round(drawn["count"]) - 1))]
    return Gear(
        teeth=round(drawn["teeth"]),
        mate_teeth=round(drawn["mate_teeth"]),
        lines=tuple({"level": decibel_to_ratio(level), "phase": _angle(draws)} for level in levels),
        shaft_modulation=drawn["shaft_modulation"],
        mate_modulation=drawn["mate_modulation"],
        phase_modulation=drawn["phase"],
        high_point=_angle(draws),
        lead_point=_angle(draws),
    )


def draw_machine_condition(recipe: Recipe, rig: int) -> ConditionSignal | None:
    """Condition of the machine of a rig; None if it is sound."""
    wanted = recipe.machine_conditions
    if wanted is None:
        return None
    draws = Draws(stream(recipe.seed, rig, 0, 0, Purpose.MACHINE_CONDITION), np.empty(0), rig, f"rig {rig}")
    if not draws.is_present(wanted):
        return None
    entry = wanted.entries[weighted_index(tuple(entry.weight for entry in wanted.entries), draws.u())]
    drawn = draws.section(entry)
    levels = [decibel_to_ratio(draws.value(entry.level_db)) for _ in range(round(drawn["count"]))]
    if levels and entry.strongest is not None:
        place, largest = min(entry.strongest, len(levels)) - 1, int(np.argmax(levels))
        levels[place], levels[largest] = levels[largest], levels[place]
    lines = [{"level": level, "phase": _angle(draws)} for level in levels]
    bursts = None
    if entry.bursts is not None:
        of_bursts = draws.section(entry.bursts)
        bursts = of_bursts | {"level": decibel_to_ratio(of_bursts["level"]), "start": _angle(draws)}
    return ConditionSignal(entry.kind, drawn["order"], tuple(lines), bursts)


def _angle(draws: Draws) -> float:
    return 2 * math.pi * draws.u()
