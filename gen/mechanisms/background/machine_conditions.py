"""Conditions that the machine of a rig can have, and how a record is labelled with them."""

from typing import TYPE_CHECKING, Any

from gen.drawing import Section
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.background.rub import Rub
from gen.mechanisms.background.shaft_lines import Belt, BentShaft, Misalignment, Unbalance
from gen.mechanisms.background.source import MachineCondition
from gen.mechanisms.mechanism import mechanisms_of, section_with, with_plugins

CONDITIONS: tuple[type[MachineCondition], ...] = with_plugins(
    MachineCondition, (Unbalance, BentShaft, Misalignment, Looseness, Rub, Belt)
)
"""All conditions, in the order in which their vibrations are added and named."""

_BALANCED = 6.3e-3  # grade up to which rotors of general machinery count as balanced, ISO 21940-11 [m/s]
_NAMED_FROM = (
    0.01  # of the static rating of the bearing; every machine has weaker forces, which light loads do not hide
)


class _Conditions(Section):
    """Conditions of the machine other than those of its bearings, the same for all classes of bearings; a machine can have several."""

    drawn_per = "rig"


if TYPE_CHECKING:
    MachineConditionsSection = Section
else:
    MachineConditionsSection = section_with("MachineConditionsSection", __name__, _Conditions, CONDITIONS)


def conditions_named(recipe: Any, rating: float) -> str:
    """Names of all conditions of the machine of a drawn recipe, joined by +, or `sound`.

    What ``machine`` has counts too: an unbalance above the grade G 6.3, forces from a hundredth of the static ``rating`` of the bearing on
    [N], and any looseness. None depends on the record.
    """
    machine = recipe.machine.si()
    there = {condition.place for condition in mechanisms_of(recipe.machine_conditions)}
    there |= {
        name
        for name, counts in (
            ("unbalance", machine["balance"] > _BALANCED * (1 + 1e-9)),
            ("bent_shaft", machine["bow"] > _NAMED_FROM * rating),
            ("misalignment", machine["misalignment"] > _NAMED_FROM * rating),
            ("looseness", machine["looseness"] > 0),
        )
        if counts
    }
    return "+".join(condition.place for condition in CONDITIONS if condition.place in there) or "sound"
