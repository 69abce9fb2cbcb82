"""Conditions of machines that are not well, of which a rig has one, and their label."""

import functools
import math
import operator
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, get_args

from pydantic import Field

from gen.corpus.fault_classes import UNKNOWN, UNKNOWN_CODE
from gen.corpus.schema import Variable
from gen.drawing import Draws, Probability, weighted_index
from gen.mechanisms.background.machine_condition import MachineCondition, bursts_of, lines_of
from gen.mechanisms.background.source import FloatArray, MachineSource, Streams
from gen.mechanisms.mechanism import with_plugins

CONDITIONS = with_plugins(MachineCondition, (MachineCondition,))
_KINDS = (*get_args(MachineCondition.model_fields["kind"].annotation), "other")
MACHINE_CONDITIONS: Mapping[int, str] = {**dict(enumerate(("sound", *_KINDS))), UNKNOWN_CODE: UNKNOWN}
"""Classes of ``machine_condition``; a condition of a plug-in is another one."""

if TYPE_CHECKING or len(CONDITIONS) == 1:
    Condition = MachineCondition
else:
    Condition = Annotated[functools.reduce(operator.or_, CONDITIONS), Field(discriminator="kind")]


def label_of(kind: Callable[[Any], str]) -> Variable:
    """The label ``machine_condition`` of a source, from the kind of condition that it stands for."""
    meaning = "condition of the machine, whatever that of its bearing"

    def code(source: Any) -> int:
        return 1 + _KINDS.index(kind(source) if kind(source) in _KINDS else "other")

    return Variable("machine_condition", "i1", "1", "label", meaning, code, MACHINE_CONDITIONS)


class MachineConditions(MachineSource):
    """Conditions of the machine other than those of its bearings, drawn per rig and the same for all classes of bearings."""

    place = "machine_conditions"
    labels = (label_of(lambda one: one.entries[0].kind),)

    probability: Probability
    """Share of the rigs whose machine has one of the conditions."""
    entries: Annotated[tuple[Condition, ...], Field(min_length=1)]
    """Conditions, one of which a machine has; drawn by weight."""

    def draw(self, of: Draws) -> Any:
        """Conditions of a rig: one entry; None for a machine that has none."""
        chosen = weighted_index(tuple(entry.weight for entry in self.entries), of.u("entries"))
        one = self.model_copy(update={"entries": (self.entries[chosen],)})
        return super(MachineConditions, one).draw(of)

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> list[FloatArray]:
        """Lines and bursts of the condition; their phases belong to the rig."""
        (condition,), of_rig = self.entries, stream(level="rig")
        start = 2 * math.pi * of_rig.random()
        lines = lines_of(condition, angles, of_rig)
        return [lines] if condition.bursts is None else [lines, bursts_of(condition.bursts, angles, start, stream())]
