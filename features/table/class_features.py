"""Features that tell a fault class, by one rule from its lines.

A comb of the whitened band belongs to the first class whose fundamental line it is. A class without a comb has the single whitened lines
that are defined.
"""

import functools
from collections.abc import Mapping

from features.table.definitions import define_features
from gen.corpus.fault_classes import BUILT_IN, FAULTS, SHAFT, NominalLine, fault_class

_DEFINED = {feature.name for feature in define_features(("lines",))}


@functools.cache
def class_features(fault: str) -> tuple[str, ...]:
    """Features whose mean level tells a class, none for a class without features of its own."""
    row = fault_class(fault)
    # no row behind that of the class is loaded
    first = next((of for of in map(fault_class, FAULTS) if of.lines[:1] == row.lines[:1]), None)
    if row is not first or not row.is_family:
        return ()
    names = [_name(line) for line in row.lines]
    comb = f"whitened_{names[0]}_comb"
    return (comb,) if comb in _DEFINED else tuple(line for name in names if (line := f"whitened_{name}") in _DEFINED)


def _name(line: NominalLine) -> str:
    """Name of a line in those of features, such as ``2bsf``."""
    base = "fr" if line.base == SHAFT.base else line.base
    return f"{line.multiple}{base}" if line.multiple > 1 else base


EVIDENCE = tuple(feature for row in BUILT_IN for feature in class_features(row.name))
"""All features that tell a built-in class."""

COMBS: Mapping[str, str] = {
    row.name: feature for row in BUILT_IN for feature in class_features(row.name) if feature.endswith("_comb")
}
"""Comb of each class that has one: all fundamental lines with a comb are those of built-in classes."""
