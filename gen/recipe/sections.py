"""All sections of a recipe.

Keys end in their unit; most numbers can be distributions. Each section is drawn at one level: per rig, per specimen or per record.
"""

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, StrictBool, StrictInt, StringConstraints, model_validator

from gen.corpus import Codec
from gen.drawing import Count, Name, Number, Section
from gen.mechanisms.background.background import BackgroundSection
from gen.mechanisms.background.machine_conditions import MachineConditionsSection
from gen.mechanisms.chain.measuring_chain import SensorFaultsSection
from gen.mechanisms.path import PathSection
from gen.recipe.fault_entries import FaultList, fault_entries
from gen.recipe.faults import Fault
from gen.recipe.life import LifeSection
from gen.recipe.machine import (
    BearingSection,
    ContactSection,
    MachineSection,
    SpecimenSection,
)
from gen.recipe.operation import OperationSection
from gen.recipe.origin import OriginSection
from gen.recipe.sensing import PhysicalLevel, RecordingSection, SnrLevel


class Split(Section):
    """Training, validation and test records; whole specimens or whole rigs belong to one of them."""

    by: Literal["specimen", "rig"] = "specimen"
    """What is kept together: all records of a specimen, or all specimens of a rig."""
    validation: Annotated[Number, Field(ge=0, lt=1)] = 0.0
    """Share of the specimens or rigs for validation."""
    test: Annotated[Number, Field(ge=0, lt=1)] = 0.2
    """Share of the specimens or rigs for testing, of rigs rounded up; the rest is for training."""


class TruthSection(Section):
    """What is known of the faults of each record."""

    twins: StrictBool = True
    """Simulates each record with a fault once more without it, to know what the fault adds to it; `false` takes less time."""
    undetected: Literal["redraw", "keep", "healthy"] = "keep"
    """What becomes of a record in which its fault cannot be seen. `keep`: it keeps its label. `redraw`: its level is drawn again, then the
    fault of its specimen. `healthy`: it is labelled healthy. With `twins: false` all records keep their labels."""


class StorageSection(Section):
    """Files of the corpus."""

    records_per_part: Annotated[StrictInt, Field(ge=1, le=100_000)] = 256
    """Number of records in one file of the corpus. A part is simulated as a whole, so it sets the memory that is needed."""
    codec: Codec = "zlib"
    """Compression of the signal: `zlib` can be read everywhere, `zstd` needs a plugin for h5py and ncdump, `none` stores it as it is."""


class CorpusSection(Section):
    """Number of rigs, specimens and records, and their split."""

    rigs: Count
    """Number of machines; each has its own draws of bearing, machine, path and background."""
    specimens_per_rig: Count
    """Number of physical bearings that each rig carries in turn. Whatever it is, the classes have the shares of their weights: exactly on
    average, and within a few specimens from the first rigs on. A rig has healthy and faulty ones if it is due at least one of each."""
    records_per_specimen: Count
    """Number of records of each physical bearing, each with its own operating conditions; with `rungs`, at each rung."""
    rungs: Annotated[tuple[Annotated[Number, Field(ge=0, le=1)], ...], Field(min_length=2, max_length=100)] | None = (
        None
    )
    """Shares of the drawn severity, in rising order, at which each record of a faulty specimen is repeated with all else the same; 0 is
    the bearing before the damage. `[0, 1]` gives counterfactual pairs, `[0, 0.25, 0.5, 1]` severity ladders. A healthy specimen gets as
    many records, each with conditions of its own."""
    fault_choice: Literal["by_weight", "in_turn"] = "by_weight"
    """`by_weight`: the classes have the shares of their weights, and entries of `faults` of one class are drawn by theirs. `in_turn`: the
    specimens take the entries of `faults` one after the other, by their number, so that each entry has as many; no weights then."""
    sampling: Literal["random", "sobol", "halton"] = "random"
    """Random numbers that the draws come from: pseudo-random, or a low-discrepancy sequence that covers ranges more evenly."""
    split: Split = Split()
    """Division into training, validation and test records."""

    @property
    def n_rungs(self) -> int:
        """Number of records with the same conditions; 1 without rungs."""
        return 1 if self.rungs is None else len(self.rungs)

    @property
    def records_of_a_specimen(self) -> int:
        """Number of all records of a specimen, of every rung."""
        return self.records_per_specimen * self.n_rungs

    @property
    def n_records(self) -> int:
        """Number of records of all rigs."""
        return self.rigs * self.specimens_per_rig * self.records_of_a_specimen

    @model_validator(mode="after")
    def _rising(self) -> Self:
        for before, after in pairwise(self.rungs or ()):
            if after <= before:
                raise ValueError(f"rungs: {after:g} after {before:g} does not rise; sort them, each once.")
        return self


class Sections(Section):
    """Keys and sections of a recipe, and the counts that follow from them; the class ``Recipe`` checks them together."""

    name: Name
    """Short name of the corpus; the `source` of each record begins with it."""
    title: Annotated[str, StringConstraints(min_length=1, max_length=200)]
    """One line about the corpus, for its data card."""
    seed: Annotated[StrictInt, Field(ge=0, lt=2**63)] = 0
    """Start of all random streams; the same recipe and seed give the same corpus."""
    corpus: CorpusSection
    """Size and split of the corpus."""
    recording: RecordingSection
    """Sample rate, duration, channels and converter of every record."""
    bearing: BearingSection
    """Type of the bearing of each rig: a designation such as "6205", a list of them, or dimensions such as
    `{n_balls: 22, pitch_diameter_mm: 60, ball_diameter_mm: 6}`; the sections below say more."""
    machine: MachineSection = MachineSection()
    """Masses, springs and dampers of each rig, and its faults other than those of the bearing."""
    machine_conditions: MachineConditionsSection = MachineConditionsSection()
    """What machines have that are not well: unbalance, looseness, a belt; all are sound if left out."""
    contact: ContactSection = ContactSection()
    """Contact of balls and races: its width and its oil."""
    specimen: SpecimenSection = SpecimenSection()
    """Clearance, conformity and waviness of each physical bearing."""
    operation: OperationSection
    """Speed, load, slip and temperature of each record."""
    faults: Annotated[
        tuple[Fault, ...],
        Field(min_length=1),
        BeforeValidator(
            fault_entries, json_schema_input_type=Annotated[tuple[Fault, ...], Field(min_length=1)] | FaultList
        ),
    ]
    """Faults that specimens can have, one entry each, with weights. `faults: {defaults: ..., entries: ...}` gives all entries some keys."""
    life: LifeSection | None = None
    """Life of each bearing: its records are snapshots of it, while its spall begins and grows. Faults have one size if it is left out."""
    path: PathSection = PathSection()
    """Transfer path from bearing to sensor, common to all channels without their own."""
    background: BackgroundSection = BackgroundSection()
    """Vibration of the machine without the bearing."""
    level: Annotated[PhysicalLevel | SnrLevel, Field(discriminator="kind")] = PhysicalLevel(kind="physical")
    """Level of bearing signal and background."""
    sensor_faults: SensorFaultsSection = SensorFaultsSection()
    """Faults of mount, cable, amplifier and data transfer; none if left out."""
    truth: TruthSection = TruthSection()
    """Twins of the records with a fault, and records in which it cannot be seen."""
    storage: StorageSection = StorageSection()
    """Size and compression of the files."""
    origin: OriginSection | None = None
    """Where the only record of the recipe comes from, if it was drawn before; `raceway replay --recipe` writes it."""
    records: Annotated[StrictInt, Field(ge=1)] | None = None
    """Number of records, if the corpus is to have fewer or more than rigs * specimens * records per specimen: the first ones, or those of
    further rigs. No record depends on it, so that a corpus can grow."""

    @property
    def n_samples(self) -> int:
        """Number of samples of a record."""
        return round(self.recording.duration_s * self.recording.sample_rate_hz)

    @property
    def n_records(self) -> int:
        """Number of records of the corpus."""
        return self.corpus.n_records if self.records is None else self.records

    @property
    def n_specimens(self) -> int:
        """Number of specimens that have records."""
        return -(-self.n_records // self.corpus.records_of_a_specimen)

    @property
    def n_rigs(self) -> int:
        """Number of rigs that have records."""
        return -(-self.n_specimens // self.corpus.specimens_per_rig)

    @property
    def n_parts(self) -> int:
        """Number of parts of the corpus."""
        return -(-self.n_records // self.storage.records_per_part)

    def specimen_of(self, record: int) -> int:
        """Number of the specimen of a record."""
        return record // self.corpus.records_of_a_specimen

    def rig_of(self, specimen: int) -> int:
        """Number of the rig of a specimen."""
        return specimen // self.corpus.specimens_per_rig

    def records_of(self, specimen: int) -> range:
        """Numbers of the records of a specimen; the last specimen may have fewer than the others."""
        return self._some_records(specimen, self.corpus.records_of_a_specimen)

    def records_of_part(self, part: int) -> range:
        """Numbers of the records of a part; the last part may have fewer than the others."""
        return self._some_records(part, self.storage.records_per_part)

    def _some_records(self, place: int, size: int) -> range:
        return range(place * size, min((place + 1) * size, self.n_records))

    def item_of(self, record: int) -> int:
        """Number of the quasi-random point of a record of a healthy specimen, and of its combination of grids.

        The first records of all groups of ``n_rungs`` records come first, then the second ones, and so on; likewise in each further turn
        of the rigs.
        """
        turn, number = divmod(record, self.corpus.n_records)
        group, place = divmod(number, self.corpus.n_rungs)
        return turn * self.corpus.n_records + place * (self.corpus.n_records // self.corpus.n_rungs) + group

    def operation_of(self, entry: int) -> OperationSection:
        """Operating conditions of the records of one entry of ``faults``."""
        changes = self.faults[entry].operation
        return self.operation if changes is None else self.operation.model_copy(update=changes.stated())

    def operations(self) -> dict[str, OperationSection]:
        """Operating conditions by their place: those of all records, and of every fault with changes of its own."""
        changed = [number for number, entry in enumerate(self.faults) if entry.operation is not None]
        return {"operation": self.operation, **{f"faults[{n}].operation": self.operation_of(n) for n in changed}}

    def level_of(self, entry: int) -> PhysicalLevel | SnrLevel:
        """Level of the records of one entry of ``faults``."""
        changes = self.faults[entry].level
        return self.level if changes is None else self.level.model_copy(update=changes.stated())
