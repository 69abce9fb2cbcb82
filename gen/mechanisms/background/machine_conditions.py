"""Conditions that the machine of a rig can have, and how a record is labelled with them."""

import math
from typing import TYPE_CHECKING, Any

from gen.drawing import Section
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.background.rub import Rub
from gen.mechanisms.background.shaft_lines import Belt, BentShaft, Misalignment, Unbalance
from gen.mechanisms.background.source import MachineCondition
from gen.mechanisms.mechanism import mechanisms_of, section_with, with_plugins
from gen.support.units import to_si

CONDITIONS: tuple[type[MachineCondition], ...] = with_plugins(
    MachineCondition, (Unbalance, BentShaft, Misalignment, Looseness, Rub, Belt)
)
"""All conditions, in the order in which their vibrations are added and named."""

_NAMED_FROM = 0.01  # of the static rating of the bearing; weaker forces leave the bearing as it is


class _Conditions(Section):
    """Conditions of the machine other than those of its bearings, the same for all classes of bearings; a machine can have several."""

    drawn_per = "rig"


if TYPE_CHECKING:
    MachineConditionsSection = Section
else:
    MachineConditionsSection = section_with("MachineConditionsSection", __name__, _Conditions, CONDITIONS)


def conditions_named(recipe: Any, rating: float) -> str:
    """Names of all conditions of the machine of a drawn recipe, joined by +, or `sound`.

    The forces on the shaft that ``machine`` has, that of the unbalance at the highest speed, count from a hundredth of the static
    ``rating`` of the bearing on [N]: neither depends on the record.
    """
    machine = recipe.machine.si()
    fastest = to_si(recipe.machine.balance_rpm or 0.0, "rpm")
    forces = {
        "unbalance": recipe.machine.unbalance * (2 * math.pi * fastest) ** 2 if fastest else 0.0,
        "bent_shaft": machine["bow"],
        "misalignment": machine["misalignment"],
        "looseness": math.inf if machine["looseness"] > 0 else 0.0,
    }
    there = {condition.place for condition in mechanisms_of(recipe.machine_conditions)}
    there |= {name for name, force in forces.items() if force > _NAMED_FROM * rating}
    return "+".join(condition.place for condition in CONDITIONS if condition.place in there) or "sound"
