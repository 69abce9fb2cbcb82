"""Where the record of a drawn recipe comes from: its numbers, on which its random streams depend, and its place among other records."""

from typing import Annotated, Literal

from pydantic import Field, StrictInt, StringConstraints

from gen.drawing import Number, Section

Place = Annotated[StrictInt, Field(ge=0, lt=2**31)]


class Snapshot(Section):
    """Place of a record in the life of its bearing; each value has the name and the unit of the variable of the corpus that it becomes."""

    age: Number
    """Age of the bearing [s]."""
    rul: Number | None = None
    """Time left to the failure [s]; none if the test ended before it and its time is not known."""
    rul_revolutions: Number | None = None
    """Turns of the shaft left to the failure."""
    event: StrictInt = 0
    """1 if the bearing failed in its test, else 0."""
    initiation_time: Number
    """Age at which the spall begins [s]."""
    spall_length: Number
    """Length of the spall, 0 before it begins [m]."""
    spall_depth: Number
    """Depth of the spall below the sound surface [m]."""
    stage: StrictInt
    """0 before the spall begins, 1 while it grows, 2 beyond the critical length."""
    overloaded: StrictInt
    """1 if the load is above the validity of ISO 281."""
    first_detectable_time: Number | None = None
    """Age at the first snapshot in which the spall can be seen [s]; none before the measurement, and if it is never seen."""


class OriginSection(Section):
    """Origin of the only record of a recipe; `raceway replay` writes it, so that the recipe gives the record again."""

    corpus: Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{1,64}$")]
    """First part of the `identity` of the records of its corpus."""
    rig: Place
    """Number of its machine."""
    specimen: Place
    """Number of its bearing."""
    record: Place
    """Number of the record in its corpus, from 0."""
    entry: Place = 0
    """Place of its fault in `faults` of the recipe of the corpus."""
    split: Literal["train", "validation", "test"] = "train"
    """Part of the corpus that the record is in: train, validation or test."""
    fault_try: Place = 0
    """Number of faults that were drawn before this one and could not be seen."""
    level_try: Place = 0
    """Number of levels that were drawn before this one and at which the fault could not be seen."""
    pair: Annotated[StrictInt, Field(ge=-1, lt=2**31)] = -1
    """Number of the group of records that differ in the severity of their fault alone; -1 if it is in no group."""
    rung: Annotated[StrictInt, Field(ge=-1, lt=2**31)] = -1
    """Place of its severity in `corpus.rungs`; -1 if it is in no group."""
    narrowest_mm: Annotated[Number, Field(gt=0)] | None = None
    """Width of the narrowest spall of its group, whose step all records of the group have; none without spalls or a group."""
    life: Snapshot | None = None
    """Place in the life of its bearing; none in a corpus without lives."""

    @property
    def first_record(self) -> int:
        """Number whose random streams the record has: that of the first record of its group."""
        return self.record - max(self.rung, 0)
