"""The recipe: a frozen model of the YAML file that a corpus is made from.

Keys end in their unit; most numbers can be distributions. Each section is drawn at one level: per rig, per specimen or per record.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, StrictInt, StringConstraints, model_validator

from gen.corpus import Codec
from gen.limits import check_limit
from gen.recipe.distributions import Number
from gen.recipe.faults import BallFault, CompoundFault, Fault, RaceFault, fault_class
from gen.recipe.loads import load_problem
from gen.recipe.machine import CatalogueBearing, ContactSection, GeometryBearing, MachineSection, SpecimenSection
from gen.recipe.operation import OperationSection, Steps, Table
from gen.recipe.section import Count, Name, Section
from gen.recipe.sensing import BackgroundSection, PathSection, PhysicalLevel, RecordingSection, SnrLevel

# memory of a record beside its signal, in samples of 12 bytes: 40 kB of drawn values, and 140 bytes per number of a table or trace
_SAMPLES_OF_A_RECORD, _SAMPLES_OF_A_NUMBER = 4000, 12


class Split(Section):
    """Training, validation and test records; whole specimens or whole rigs belong to one of them."""

    by: Literal["specimen", "rig"] = "specimen"
    """What is kept together: all records of a specimen, or all specimens of a rig."""
    validation: Annotated[Number, Field(ge=0, lt=1)] = 0.0
    """Share of the specimens or rigs for validation."""
    test: Annotated[Number, Field(ge=0, lt=1)] = 0.2
    """Share of the specimens or rigs for testing; the rest is for training."""


class CorpusSection(Section):
    """Number of rigs, specimens and records, their split, and their storage."""

    rigs: Count
    """Number of machines; each has its own draws of bearing, machine, path and background."""
    specimens_per_rig: Count
    """Number of physical bearings that each rig carries in turn; at least 2 for a recipe with several classes."""
    records_per_specimen: Count
    """Number of records of each physical bearing, each with its own operating conditions."""
    records_per_part: Annotated[StrictInt, Field(ge=1, le=100_000)] = 256
    """Number of records in one file of the corpus. A part is simulated as a whole, so it sets the memory that is needed."""
    sampling: Literal["random", "sobol", "halton"] = "random"
    """Random numbers that the draws come from: pseudo-random, or a low-discrepancy sequence that covers ranges more evenly."""
    split: Split = Split()
    """Division into training, validation and test records."""
    codec: Codec = "zlib"
    """Compression of the signal: `zlib` can be read everywhere, `zstd` needs a plugin for h5py and ncdump, `none` stores it as it is."""


class Recipe(Section):
    """All that a corpus is made from."""

    name: Name
    """Short name of the corpus; the `source` of each record begins with it."""
    title: Annotated[str, StringConstraints(min_length=1, max_length=200)]
    """One line about the corpus, for its data card."""
    seed: Annotated[StrictInt, Field(ge=0, lt=2**63)] = 0
    """Start of all random streams; the same recipe and seed give the same corpus."""
    corpus: CorpusSection
    """Size, split and storage of the corpus."""
    recording: RecordingSection
    """Sample rate, duration, channels and converter of every record."""
    bearing: Annotated[CatalogueBearing | GeometryBearing, Field(discriminator="kind")]
    """Type of the bearing of each rig."""
    machine: MachineSection = MachineSection()
    """Masses, springs and dampers of each rig, and its faults other than those of the bearing."""
    contact: ContactSection = ContactSection()
    """Contact of balls and races: its width and its oil."""
    specimen: SpecimenSection = SpecimenSection()
    """Clearance, conformity and waviness of each physical bearing."""
    operation: OperationSection
    """Speed, load, slip and temperature of each record."""
    faults: Annotated[tuple[Fault, ...], Field(min_length=1)]
    """Faults that specimens can have, one entry each, with weights."""
    path: PathSection = PathSection()
    """Transfer path from bearing to sensor, common to all channels without their own."""
    background: BackgroundSection = BackgroundSection()
    """Vibration of the machine without the bearing."""
    level: Annotated[PhysicalLevel | SnrLevel, Field(discriminator="kind")] = PhysicalLevel()
    """Level of bearing signal and background."""
    records: Annotated[StrictInt, Field(ge=1)] | None = None
    """Number of records, if the corpus is to have fewer than rigs * specimens * records per specimen; the first ones are made."""

    def __hash__(self) -> int:
        """Hash of name and seed; the hash of pydantic fails on the dictionaries of some sections."""
        return hash((self.name, self.seed))

    @property
    def n_samples(self) -> int:
        """Number of samples of a record."""
        return round(self.recording.duration_s * self.recording.sample_rate_hz)

    @property
    def n_records(self) -> int:
        """Number of records of the corpus."""
        corpus = self.corpus
        whole = corpus.rigs * corpus.specimens_per_rig * corpus.records_per_specimen
        return whole if self.records is None else min(whole, self.records)

    @property
    def n_parts(self) -> int:
        """Number of parts of the corpus."""
        return -(-self.n_records // self.corpus.records_per_part)

    @model_validator(mode="after")
    def _within_limits(self) -> Self:
        """Check counts and sizes before anything is drawn; the limits keep the memory of a part to a few gigabytes."""
        corpus, recording = self.corpus, self.recording
        whole = corpus.rigs * corpus.specimens_per_rig * corpus.records_per_specimen
        # checked even if records: ends the corpus early, because the splits are drawn over all of its rigs
        place = "corpus: rigs * specimens_per_rig * records_per_specimen"
        check_limit("records", whole, f"{place} are", ValueError)
        check_limit("rig_specimens", corpus.specimens_per_rig, "corpus.specimens_per_rig: asks for", ValueError)
        seconds = recording.settle_s + recording.duration_s
        samples = round(seconds * recording.sample_rate_hz) * len(recording.channels)
        check_limit(
            "record_samples", samples, "recording: a record of all channels, settle_s included, has", ValueError
        )
        records = min(self.n_records, corpus.records_per_part)
        needed = samples + _SAMPLES_OF_A_RECORD + _SAMPLES_OF_A_NUMBER * self._numbers_of_a_record()
        check_limit("part_samples", records * needed, f"corpus.records_per_part: {records} records need", ValueError)
        return self

    def _numbers_of_a_record(self) -> int:
        """Count of the numbers of profiles and traces that each record holds."""
        profiles = (self.operation.speed_profile, self.operation.load_profile)
        tables = sum(2 * len(profile.times_s) for profile in profiles if isinstance(profile, Table))
        traces = [0]
        for fault in self.faults:
            parts = fault.parts if isinstance(fault, CompoundFault) else (fault,)
            spalled = [part for part in parts if isinstance(part, RaceFault | BallFault)]
            traces.append(sum(round(part.n_spalls.support()[1]) * len(part.trace_um or ()) for part in spalled))
        return tables + max(traces)

    @model_validator(mode="after")
    def _edges_have_a_slope(self) -> Self:
        for number, fault in enumerate(self.faults):
            parts = fault.parts if isinstance(fault, CompoundFault) else (fault,)
            spalled = [part for part in parts if isinstance(part, RaceFault | BallFault)]
            if self.contact.ball_mass == "steel" and any(part.profile == "rectangular" for part in spalled):
                raise ValueError(
                    f"faults[{number}].profile: the walls of a rectangular spall have no slope that gives the speed of an impact; "
                    f"take another profile, or contact.ball_mass: none."
                )
        return self

    @model_validator(mode="after")
    def _can_be_made(self) -> Self:
        kinds = {fault_class(fault) for fault in self.faults if fault.weight > 0}
        if not kinds:
            raise ValueError("faults all have weight 0; give at least one a weight above 0.")
        if len(kinds) > 1 and self.corpus.specimens_per_rig < 2:
            raise ValueError(
                "corpus.specimens_per_rig: 1 is not enough for healthy and faulty bearings on every rig; use at least 2."
            )
        if self.corpus.split.validation + self.corpus.split.test >= 1:
            raise ValueError("corpus.split: validation and test leave nothing to train on; make their sum less than 1.")
        if self.machine.resonator is None and any("sensor" in channel.body for channel in self.recording.channels):
            raise ValueError("recording.channels: body sensor needs machine.resonator; give one, or use body: housing.")
        for place, path in [
            ("path", self.path),
            *((f"recording.channels[{n}].path", c.path) for n, c in enumerate(self.recording.channels)),
        ]:
            if path is not None and path.silent():
                raise ValueError(
                    f"{place}.direct: 0 without modes transmits nothing; give modes or a direct part above 0."
                )
        if self.n_samples < 16:
            raise ValueError(f"recording.duration_s: {self.n_samples} samples are too few; use at least 16.")
        if self.operation.axial_load_n.support()[1] > 0 and not self._slanted():
            raise ValueError(
                "operation.axial_load_n: needs a contact angle; give specimen.contact_angle_deg or a bearing that has one."
            )
        beyond = load_problem(self.bearing, self.specimen, self.operation)
        if beyond is not None:
            raise ValueError(beyond)
        if "temperature_celsius" in self.operation.model_fields_set and self.contact.lubricant is None:
            raise ValueError(
                "operation.temperature_celsius: has no effect without oil; give contact.lubricant, or leave it out."
            )
        for key, profile in (("speed", self.operation.speed_profile), ("load", self.operation.load_profile)):
            if isinstance(profile, Steps) and profile.step_s * len(profile.levels_percent) > self.recording.duration_s:
                raise ValueError(
                    f"operation.{key}_profile.step_s: {profile.step_s:g} s is longer than a level; keep it below "
                    f"{self.recording.duration_s / len(profile.levels_percent):.3g}."
                )
        if len({channel.name for channel in self.recording.channels}) < len(self.recording.channels):
            raise ValueError("recording.channels: two channels have the same name; give each its own.")
        return self

    def _slanted(self) -> bool:
        """Whether some bearing has a contact angle."""
        angles = {0.0, *self.specimen.contact_angle_deg.support()}
        if isinstance(self.bearing, CatalogueBearing):
            angles |= {self.bearing.bearing(designation).contact_angle for designation in self.bearing.designations}
        else:
            angles |= set(self.bearing.contact_angle_deg.support())
        return angles != {0.0}
