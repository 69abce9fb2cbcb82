"""Table of the fault classes: everything that a class means to corpora, features, baselines and pictures.

A new class needs one new row at the end: the codes of stored records are places in the table. This module imports nothing of the project.

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
        Value of ``fault`` in a corpus.
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
    n_spalls
        Spalls of a recording that does not state their number.
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
    n_spalls: int = 0

    @property
    def evidence(self) -> tuple[str, ...]:
        """Features whose mean level tells this class, none for a class without a line of its own."""
        return (self.comb,) if self.comb else self.single_lines


def _harmonics(base: str, *multiples: int) -> tuple[NominalLine, ...]:
    return tuple(NominalLine(f"{n} {base.upper()}" if n > 1 else base.upper(), base, n) for n in multiples)


BPFI, BPFO = _harmonics("bpfi", 1, 2, 3), _harmonics("bpfo", 1, 2, 3)
BSF, FTF = _harmonics("bsf", 2, 4, 6), _harmonics("ftf", 1, 2, 3)
SHAFT = NominalLine("shaft", "shaft", 1)

HEALTHY = "healthy"
UNKNOWN, UNKNOWN_CODE = "unknown", 127  # recording whose class is not known: a value of ``fault``, not a class
CLASSES: Mapping[str, FaultClass] = {
    row.name: row
    for row in (
        FaultClass(HEALTHY, "#009E73", words="Healthy"),
        FaultClass(
            "inner",
            "#D55E00",
            BPFI,
            "whitened_bpfi_comb",
            words="Inner race fault",
            part="inner race",
            beside="needed",
            n_spalls=1,
        ),
        FaultClass(
            "outer",
            "#0072B2",
            BPFO,
            "whitened_bpfo_comb",
            words="Outer race fault",
            part="outer race",
            beside="lower",
            n_spalls=1,
        ),
        FaultClass(
            "ball",
            "#CC79A7",
            BSF,
            "whitened_2bsf_comb",
            words="Ball fault",
            part="balls",
            side="ftf",
            companion="cage",
            n_spalls=1,
        ),
        FaultClass(
            "cage", "#E69F00", FTF, single_lines=("whitened_ftf", "whitened_2ftf"), words="Cage fault", part="cage"
        ),
        # the label does not say which parts are damaged, so the fundamental line of every part is marked
        FaultClass("compound", "#56B4E9", (BPFI[0], BPFO[0], BSF[0], FTF[0]), words="Several faults", n_spalls=2),
    )
}
"""Rows by name. Colours: see `raceway.reports.pictures`."""

FAULTS = tuple(CLASSES)
"""Names of the classes; the code of a class is its place."""

FAULT_NAMES: Mapping[int, str] = {**dict(enumerate(FAULTS)), UNKNOWN_CODE: UNKNOWN}

LOOKS: Mapping[str, FaultClass] = {**CLASSES, UNKNOWN: FaultClass(UNKNOWN, "#444444", n_spalls=-1)}
"""Rows of the classes, and of records whose class is not known."""

SIDES = {SHAFT.base: "shaft", "ftf": "cage"}
"""Part that turns at the distance of sidebands."""

COMBS: Mapping[str, str] = {name: row.comb for name, row in CLASSES.items() if row.comb}
"""Comb of each class that has one of its own."""

EVIDENCE = tuple(feature for row in CLASSES.values() for feature in row.evidence)
"""All features that tell a class."""

FUNDAMENTALS = tuple(row.lines[0] for row in CLASSES.values() if row.evidence)
"""Fundamental line of each class that has lines of its own."""
