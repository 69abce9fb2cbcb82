"""Table of the fault classes: everything that a class of the corpus format means to features, baselines and pictures.

A new class of the format needs one new row here, at its place in the order of the format; a test compares the two.
This module imports nothing of the project, so that the pure signal functions may use it.

A ball spall strikes both races in each spin, so its fundamental line is twice the ball spin frequency ``bsf``.
"""

from collections.abc import Mapping
from typing import Literal, NamedTuple


class NominalLine(NamedTuple):
    """Line of an envelope spectrum: its label in pictures, and its order as a multiple of a nominal order.

    ``base`` is a field of `features.signal.lines.Orders`, or ``shaft`` for the shaft rate itself.
    """

    label: str
    base: str
    multiple: int


class FaultClass(NamedTuple):
    """One fault class.

    Attributes
    ----------
    name
        As in ``gen.corpus.FAULTS``.
    colour
        In all pictures.
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
    """

    name: str
    colour: str
    lines: tuple[NominalLine, ...] = ()
    comb: str = ""
    single_lines: tuple[str, ...] = ()
    words: str = ""
    part: str = ""
    side: str = "shaft"
    beside: Literal["", "needed", "lower"] = ""
    companion: str = ""

    @property
    def evidence(self) -> tuple[str, ...]:
        """Features whose mean level tells this class, none for a class without a line of its own."""
        return (self.comb,) if self.comb else self.single_lines


def _harmonics(base: str, *multiples: int) -> tuple[NominalLine, ...]:
    return tuple(NominalLine(f"{n} {base.upper()}" if n > 1 else base.upper(), base, n) for n in multiples)


BPFI, BPFO = _harmonics("bpfi", 1, 2, 3), _harmonics("bpfo", 1, 2, 3)
BSF, FTF = _harmonics("bsf", 2, 4, 6), _harmonics("ftf", 1, 2, 3)
SHAFT = NominalLine("shaft", "shaft", 1)

HEALTHY, UNKNOWN = "healthy", "unknown"
CLASSES: Mapping[str, FaultClass] = {
    row.name: row
    for row in (
        FaultClass(HEALTHY, "#009E73", words="Healthy"),
        FaultClass(
            "inner", "#D55E00", BPFI, "whitened_bpfi_comb", words="Inner race fault", part="inner race", beside="needed"
        ),
        FaultClass(
            "outer", "#0072B2", BPFO, "whitened_bpfo_comb", words="Outer race fault", part="outer race", beside="lower"
        ),
        FaultClass(
            "ball", "#CC79A7", BSF, "whitened_2bsf_comb", words="Ball fault", part="balls", side="ftf", companion="cage"
        ),
        FaultClass(
            "cage", "#E69F00", FTF, single_lines=("whitened_ftf", "whitened_2ftf"), words="Cage fault", part="cage"
        ),
        # the label does not say which parts are damaged, so the fundamental line of every part is marked
        FaultClass("compound", "#56B4E9", (BPFI[0], BPFO[0], BSF[0], FTF[0]), words="Several faults"),
    )
}
"""Rows by name, in the order of the codes of the format. Colours: see `features.report.pictures`."""

LOOKS: Mapping[str, FaultClass] = {**CLASSES, UNKNOWN: FaultClass(UNKNOWN, "#444444")}
"""Rows for pictures: of the classes, and of records whose class is not known."""

SIDES = {SHAFT.base: "shaft", "ftf": "cage"}
"""Part that turns at the distance of sidebands."""

COMBS: Mapping[str, str] = {name: row.comb for name, row in CLASSES.items() if row.comb}
"""Comb of each class that has one of its own."""

EVIDENCE = tuple(feature for row in CLASSES.values() for feature in row.evidence)
"""All features that tell a class."""

FUNDAMENTALS = tuple(row.lines[0] for row in CLASSES.values() if row.evidence)
"""Fundamental line of each class that has lines of its own."""
