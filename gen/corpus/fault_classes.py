"""Table of the fault classes, and their codes in a process and in a file.

A plug-in adds a row by an entry point of the group ``raceway.classes``, which has the name of the class. A row is loaded when it is first
read, because a plug-in imports this module. `features.table.class_features` says which features tell a class.

The code of a class is its place among the classes of this process. In the files of a corpus, the classes of plug-ins that the corpus has
follow the built-in ones. So they do not depend on what else is installed, and whoever reads them translates.

A ball spall strikes both races in each spin, so its fundamental line is twice the ball spin frequency ``bsf``.
"""

import functools
import json
import re
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.support.errors import CorpusError, RacewayError
from gen.support.plugins import missing_distributions, plugin, plugins, unusable


class NominalLine(NamedTuple):
    """Line of an envelope spectrum: its label in pictures, and its order as a multiple of a nominal order.

    ``base`` is a field of `features.signal.lines.Orders`, or ``shaft`` for the shaft rate itself.
    """

    label: str
    base: str
    multiple: int

    def order(self, orders: Any) -> Any:
        """Order of the line for the nominal orders of a bearing."""
        return self.multiple * getattr(orders, self.base, 1.0)


class FaultClass(NamedTuple):
    """One fault class.

    Attributes
    ----------
    name
        Value of ``fault`` in a corpus.
    lines
        The lines marked in its pictures; for a class with harmonics, the fundamental line first.
    words
        The class in a sentence.
    part
        The damaged part in a sentence, empty if the class does not name one.
    side
        Distance of the sidebands of its lines: a field of `features.signal.lines.Orders`, or ``shaft``. A spall on a ball
        passes the load zone with the cage.
    beside
        What the sidebands of its lines at the shaft rate are like: ``needed`` on an inner race, which turns through the load zone,
        ``lower`` than the lines on an outer race, which stands still, or empty.
    companion
        Class whose lines go with those of this one, so that they do not speak against it.
    n_spalls
        Spalls of a recording that does not state their number.
    """

    name: str
    lines: tuple[NominalLine, ...] = ()
    words: str = ""
    part: str = ""
    side: str = "shaft"
    beside: Literal["", "needed", "lower"] = ""
    companion: str = ""
    n_spalls: int = 0

    @property
    def is_family(self) -> bool:
        """Whether its lines are multiples of one order."""
        return len({line.base for line in self.lines}) == 1


def harmonics(base: str, *multiples: int) -> tuple[NominalLine, ...]:
    """Lines at multiples of a nominal order.

    >>> [line.label for line in harmonics("bsf", 2, 4)]
    ['2 BSF', '4 BSF']
    """
    return tuple(NominalLine(f"{n} {base.upper()}" if n > 1 else base.upper(), base, n) for n in multiples)


HEALTHY = "healthy"
UNKNOWN, UNKNOWN_CODE = "unknown", 127  # recording whose class is not known: a value of ``fault``, not a class

BPFI, BPFO = harmonics("bpfi", 1, 2, 3), harmonics("bpfo", 1, 2, 3)
BSF, FTF = harmonics("bsf", 2, 4, 6), harmonics("ftf", 1, 2, 3)
SHAFT = NominalLine("shaft", "shaft", 1)

BUILT_IN = (
    FaultClass(HEALTHY, words="Healthy"),
    FaultClass("inner", BPFI, words="Inner race fault", part="inner race", beside="needed", n_spalls=1),
    FaultClass("outer", BPFO, words="Outer race fault", part="outer race", beside="lower", n_spalls=1),
    FaultClass("ball", BSF, part="balls", side="ftf", companion="cage", n_spalls=1),
    FaultClass("cage", FTF, part="cage"),
    # the label does not say which parts are damaged, so the fundamental line of every part is marked
    FaultClass("compound", (BPFI[0], BPFO[0], BSF[0], FTF[0]), words="Several faults", n_spalls=2),
)

SIDES = {SHAFT.base: "shaft", "ftf": "cage"}
"""Part that turns at the distance of sidebands."""

FAULTS = (*(row.name for row in BUILT_IN), *plugins("classes"))
"""Names of the classes; the code of a class is its place."""

FAULT_NAMES: Mapping[int, str] = {**dict(enumerate(FAULTS)), UNKNOWN_CODE: UNKNOWN}

for _name in plugins("classes"):
    if not re.fullmatch("[a-z][a-z0-9_]*", _name) or _name in (*FAULTS[: len(BUILT_IN)], UNKNOWN):
        raise RacewayError(f"raceway.classes: {_name!r} is no name for a further class; uninstall its plug-in.")


@functools.cache
def fault_class(name: str) -> FaultClass:
    """Row of a class, or of records whose class is not known."""
    rows = {row.name: row for row in (*BUILT_IN, FaultClass(UNKNOWN, n_spalls=-1))}
    row = rows[name] if name in rows else plugin("classes", name, FaultClass)
    if name not in rows and (row.name != name or row.companion not in ("", *FAULTS)):
        raise unusable("classes", name, f"it is named {row.name}, and its companion {row.companion or 'none'}")
    return row._replace(name=name, words=row.words or f"{name.replace('_', ' ').capitalize()} fault")


def families() -> tuple[FaultClass, ...]:
    """Classes whose lines are multiples of one order, the first class of each order."""
    rows: dict[NominalLine, FaultClass] = {}
    for row in map(fault_class, FAULTS):
        if row.is_family:
            rows.setdefault(row.lines[0], row)
    return tuple(rows.values())


def fundamentals() -> tuple[NominalLine, ...]:
    """Fundamental line of each of the `families`."""
    return tuple(row.lines[0] for row in families())


def further_classes(codes: NDArray[Any]) -> list[str]:
    """Classes of plug-ins among codes of this process."""
    return [FAULTS[code] for code in range(len(BUILT_IN), len(FAULTS)) if (codes == code).any()]


def file_codes(codes: NDArray[Any], further: Sequence[str]) -> tuple[NDArray[Any], dict[int, str]]:
    """Codes of ``fault`` in a file, of those of this process, and their names there: ``further`` classes follow the built-in ones."""
    names, stored = (*FAULTS[: len(BUILT_IN)], *further), codes.copy()
    for code, name in enumerate(names):
        stored[codes == FAULTS.index(name)] = code
    return stored, {**dict(enumerate(names)), UNKNOWN_CODE: UNKNOWN}


def own_codes(
    codes: NDArray[Any], names: Mapping[int, str], place: object, attributes: Mapping[Any, Any]
) -> NDArray[np.int8]:
    """Codes of ``fault`` in this process, of those of a file with their ``names`` there; -1 for a code without a name.

    Raises
    ------
    CorpusError
        If a record is of a class that this process does not have; ``attributes`` of the file have the ``versions`` that made it.
    """
    own, unique, place_of = {name: code for code, name in FAULT_NAMES.items()}, *np.unique(codes, return_inverse=True)
    held = [names.get(int(code), "") for code in unique]
    if (foreign := next((name for name in held if name and name not in own), None)) is not None:
        missing = " ".join(missing_distributions(json.loads(attributes.get("versions", "{}"))))
        # a name in a stranger's file is no advice to install it
        raise CorpusError(
            f"{place}: has records of the class {foreign}, which comes from a plug-in{missing and f', {missing}'}; get it from the maker "
            "of the corpus."
        )
    return np.array([own.get(name, -1) for name in held], np.int8)[place_of]
