"""Entries of `faults`: each kind of fault of a bearing, with its share of the records and its conditions."""

import functools
import operator
from typing import TYPE_CHECKING, Annotated, Any, get_args

from pydantic import Field

from gen.corpus import FAULTS
from gen.corpus.fault_classes import fault_class
from gen.drawing import Weight, composed
from gen.mechanisms.faults.bearing_fault import BearingFault
from gen.mechanisms.faults.kinds import KINDS
from gen.recipe.changes import LevelChanges, OperationChanges
from gen.support.plugins import plugin, plugins, unusable


class FaultEntry(BearingFault):
    """One entry of `faults`."""

    weight: Weight = 1.0
    """Share of the records with this fault, relative to the other entries of `faults`, whatever `corpus.specimens_per_rig` is."""
    operation: OperationChanges | None = None
    """Keys of `operation` that replace those of the recipe for this entry. Beware: speed or load alone may then tell its class."""
    level: LevelChanges | None = None
    """Keys of `level` that replace those of the recipe for this entry, with `level.kind: snr`. Beware: they too may tell its class."""


def _entry(kind: type[BearingFault]) -> Any:
    return composed(kind.__name__, __name__, (kind, FaultEntry), kind.__doc__)


_ENTRIES = tuple(map(_entry, KINDS))
OF_KIND = {kind: entry for entry in _ENTRIES for kind in get_args(entry.model_fields["kind"].annotation)}
"""Entry of each kind."""

for _kind, _model in OF_KIND.items():
    _added = [name for name in plugins("mechanisms") if issubclass(_model, plugin("mechanisms", name, type))]
    if _kind in FAULTS or not _added:
        continue
    # a class that is not named as its entry point would be taken for that of the site
    for _name in plugins("classes"):
        fault_class(_name)
    if "site" not in {*_model.model_fields, *_model.__class_vars__}:
        raise unusable("mechanisms", _added[0], f"fault kind {_kind} is no class and has no site")

if TYPE_CHECKING:
    Fault = FaultEntry
else:
    Fault = Annotated[functools.reduce(operator.or_, _ENTRIES), Field(discriminator="kind")]


def __getattr__(name: str) -> Any:
    """Entry by the name of its class, as pickle asks for it where a recipe arrives in another process."""
    for entry in _ENTRIES:
        if entry.__name__ == name:
            return entry
    raise AttributeError(name)


def class_of(fault: Fault) -> str:
    """Class label of records with a fault."""
    return fault.kind if fault.kind in FAULTS else fault.part
