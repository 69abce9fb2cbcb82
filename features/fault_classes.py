"""Table of the fault classes: the lines and features that tell a class, and its words in sentences.

A plug-in adds a row by an entry point of the group ``raceway.classes``, which has the name of the class; rows of plug-ins are loaded when
they are first read. Codes of classes are in `gen.corpus.fault_classes`, colours in `raceway.reports.class_colours`.

A ball spall strikes both races in each spin, so its fundamental line is twice the ball spin frequency ``bsf``.
"""

import functools
from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple

from gen.corpus.fault_classes import FAULTS, HEALTHY, UNKNOWN
from gen.support.plugins import plugin


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
    comb
        The feature that averages three harmonics of its line, empty if no comb belongs to this class alone.
    single_lines
        Features whose mean tells the class where it has no comb of its own.
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
    comb: str = ""
    single_lines: tuple[str, ...] = ()
    words: str = ""
    part: str = ""
    side: str = "shaft"
    beside: Literal["", "needed", "lower"] = ""
    companion: str = ""
    n_spalls: int = 0

    @property
    def evidence(self) -> tuple[str, ...]:
        """Features whose mean level tells this class, none for a class without features of its own."""
        return (self.comb,) if self.comb else self.single_lines

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


BPFI, BPFO = harmonics("bpfi", 1, 2, 3), harmonics("bpfo", 1, 2, 3)
BSF, FTF = harmonics("bsf", 2, 4, 6), harmonics("ftf", 1, 2, 3)
SHAFT = NominalLine("shaft", "shaft", 1)

_BUILT_IN: Mapping[str, FaultClass] = {
    row.name: row
    for row in (
        FaultClass(HEALTHY, words="Healthy"),
        FaultClass(
            "inner",
            BPFI,
            "whitened_bpfi_comb",
            words="Inner race fault",
            part="inner race",
            beside="needed",
            n_spalls=1,
        ),
        FaultClass(
            "outer",
            BPFO,
            "whitened_bpfo_comb",
            words="Outer race fault",
            part="outer race",
            beside="lower",
            n_spalls=1,
        ),
        FaultClass(
            "ball",
            BSF,
            "whitened_2bsf_comb",
            words="Ball fault",
            part="balls",
            side="ftf",
            companion="cage",
            n_spalls=1,
        ),
        FaultClass("cage", FTF, single_lines=("whitened_ftf", "whitened_2ftf"), words="Cage fault", part="cage"),
        # the label does not say which parts are damaged, so the fundamental line of every part is marked
        FaultClass("compound", (BPFI[0], BPFO[0], BSF[0], FTF[0]), words="Several faults", n_spalls=2),
        FaultClass(UNKNOWN, n_spalls=-1),
    )
}


@functools.cache
def _row(name: str) -> FaultClass:
    if name in _BUILT_IN:
        return _BUILT_IN[name]
    row = plugin("classes", name, FaultClass)
    return row._replace(name=name, words=row.words or f"{name.replace('_', ' ').capitalize()} fault")


class _Rows(Mapping[str, FaultClass]):
    """Rows by name, each loaded when it is first read: a plug-in may import this module."""

    def __init__(self, *names: str) -> None:
        self._names = names

    def __getitem__(self, name: str) -> FaultClass:
        if name not in self._names:
            raise KeyError(name)
        return _row(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


CLASSES: Mapping[str, FaultClass] = _Rows(*FAULTS)
"""Rows of the classes by name."""

ALL_CLASSES: Mapping[str, FaultClass] = _Rows(*FAULTS, UNKNOWN)
"""The same, and the row of records whose class is not known."""

SIDES = {SHAFT.base: "shaft", "ftf": "cage"}
"""Part that turns at the distance of sidebands."""

COMBS: Mapping[str, str] = {name: row.comb for name, row in _BUILT_IN.items() if row.comb}
"""Comb of each built-in class that has one of its own."""

EVIDENCE = tuple(feature for row in _BUILT_IN.values() for feature in row.evidence)
"""All features that tell a built-in class."""


def families() -> tuple[FaultClass, ...]:
    """Classes whose lines are multiples of one order, the first class of each order."""
    rows: dict[NominalLine, FaultClass] = {}
    for row in CLASSES.values():
        if row.is_family:
            rows.setdefault(row.lines[0], row)
    return tuple(rows.values())


def fundamentals() -> tuple[NominalLine, ...]:
    """Fundamental line of each of the `families`."""
    return tuple(row.lines[0] for row in families())
