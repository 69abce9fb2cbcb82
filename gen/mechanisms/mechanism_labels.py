"""Variables of the corpus that tell what mechanisms did to a record."""

from typing import Any

from gen.corpus.schema import Variable
from gen.mechanisms.background.background import LOCKED, locked_of
from gen.mechanisms.background.machine_conditions import CONDITIONS
from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.mechanisms.faults.kinds import KINDS
from gen.support.errors import RacewayError
from gen.support.plugins import plugin, plugins

for _name in plugins("mechanisms"):
    if plugin("mechanisms", _name, type) not in (*KINDS, *LOCKED, *CHAIN, *CONDITIONS):
        raise RacewayError(
            f"raceway.mechanisms: {_name} is no BearingFault, LockedSource, SensorFault or MachineCondition, so it would do nothing."
        )

LABELS: tuple[Variable, ...] = tuple(
    {label.name: label for mechanism in (*KINDS, *LOCKED, *CHAIN) for label in mechanism.labels}.values()
)
"""Of faults, of the background, then of the measuring chain."""


def label_values(recipe: Any, chain: dict[str, float]) -> dict[str, float]:
    """Values of all ``LABELS`` of a drawn recipe, 0 for those of mechanisms that it does not have; ``chain`` has those of the chain.

    A later source may change a label of an earlier one.
    """
    there = *recipe.faults[0].components, *locked_of(recipe)
    known = {label.name: label.column([one])[0] for one in there for label in one.labels} | chain
    return {label.name: known.get(label.name, 0) for label in LABELS}
