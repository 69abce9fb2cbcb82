"""Variables of the corpus that tell what mechanisms did to a record."""

from collections.abc import Container
from typing import Any

from gen.corpus.schema import Variable
from gen.mechanisms.background.background import MACHINE_SOURCES, machine_sources_of
from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.mechanisms.faults.kinds import KINDS
from gen.support.errors import RacewayError
from gen.support.plugins import plugin, plugins

for _name in plugins("mechanisms"):
    if plugin("mechanisms", _name, type) not in (*KINDS, *MACHINE_SOURCES, *CHAIN):
        raise RacewayError(
            f"raceway.mechanisms: {_name} is no BearingFault, MachineSource, SensorFault or MachineCondition, so it would do nothing."
        )


def labels_with(added: Container[str] = ()) -> tuple[Variable, ...]:
    """Of faults, of the background, then of the measuring chain: all that are built in, and those ``added`` by some plug-ins."""
    absent = [plugin("mechanisms", name, type) for name in plugins("mechanisms") if name not in added]
    mechanisms = (kind for kind in (*KINDS, *MACHINE_SOURCES, *CHAIN) if kind not in absent)
    return tuple({label.name: label for kind in mechanisms for label in kind.labels}.values())


def label_values(recipe: Any, chain: dict[str, float]) -> dict[str, float]:
    """Values of the labels of the mechanisms that a drawn recipe has; ``chain`` has those of the measuring chain.

    A later source may change a label of an earlier one.
    """
    there = *recipe.faults[0].components, *machine_sources_of(recipe)
    return {label.name: label.column([mechanism])[0] for mechanism in there for label in mechanism.labels} | chain
