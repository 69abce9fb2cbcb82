"""Conditions that the machine of a rig can have, and how a record is labelled with them."""

import math
from typing import TYPE_CHECKING, Any

from gen.drawing import Section
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.background.source import MachineCondition
from gen.mechanisms.background.rub import Rub
from gen.mechanisms.background.shaft_lines import Belt, BentShaft, Misalignment, Unbalance
from gen.mechanisms.mechanism import mechanisms_of, section_with, with_plugins

CONDITIONS: tuple[type[MachineCondition], ...] = with_plugins(
    MachineCondition, (Unbalance, BentShaft, Misalignment, Looseness, Rub, Belt)
)
"""All conditions, in the order in which their vibrations are added and named."""

_NAMED_FROM = 0.1  # of the radial load; a weaker force leaves the bearing as it is


class _Conditions(Section):
    """Conditions of the machine other than those of its bearings, the same for all classes of bearings; a machine can have several."""

    drawn_per = "rig"


if TYPE_CHECKING:
    MachineConditionsSection = Section
else:
    MachineConditionsSection = section_with("MachineConditionsSection", __name__, _Conditions, CONDITIONS)


def conditions_named(recipe: Any, load: float, shaft_rate: float) -> str:
    """Names of all conditions of the machine of a drawn recipe, joined by +, or `sound`.

    The forces on the shaft that ``machine`` has count from a tenth of the radial ``load`` [N] on, at the ``shaft_rate`` [Hz].
    """
    machine = recipe.machine.si()
    forces = {
        "unbalance": recipe.machine.unbalance * (2 * math.pi * shaft_rate) ** 2,
        "bent_shaft": machine["bow"],
        "misalignment": machine["misalignment"],
        "looseness": math.inf if machine["looseness"] > 0 else 0.0,
    }
    there = {condition.place for condition in mechanisms_of(recipe.machine_conditions)}
    there |= {name for name, force in forces.items() if force > max(_NAMED_FROM * load, 0.0)}
    return "+".join(condition.place for condition in CONDITIONS if condition.place in there) or "sound"
