"""The recipe: what a corpus is made of, frozen once it is read.

Keys end in their unit; every number may be a distribution. What is drawn once per machine, per bearing and per record stands in
sections of its own.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, StrictInt, StringConstraints, model_validator

from gen.corpus import Codec
from gen.limits import check_limit
from gen.recipe.distributions import Number
from gen.recipe.faults import BallFault, CompoundFault, Fault, RaceFault, fault_class
from gen.recipe.loads import load_problem
from gen.recipe.machine import CatalogueBearing, Contact, GeometryBearing, Machine, Specimen
from gen.recipe.operation import Operation, Steps, Table
from gen.recipe.section import Count, Name, Section
from gen.recipe.sensing import Background, Path, PhysicalLevel, Recording, SnrLevel

# what a record takes beside its signal, in samples of 12 bytes: 40 kB of drawn values, and 140 bytes per number of a table or trace
_SAMPLES_OF_A_RECORD, _SAMPLES_OF_A_NUMBER = 4000, 12


class Split(Section):
    """Which share of the corpus is set aside, by whole specimens or whole rigs."""

    by: Literal["specimen", "rig"] = "specimen"
    validation: Annotated[Number, Field(ge=0, lt=1)] = 0.0
    test: Annotated[Number, Field(ge=0, lt=1)] = 0.2


class CorpusSection(Section):
    """How many machines, bearings and records, how they are spread, and how they are stored."""

    rigs: Count
    specimens_per_rig: Count
    records_per_specimen: Count
    records_per_part: Annotated[StrictInt, Field(ge=1, le=100_000)] = 256
    sampling: Literal["random", "sobol", "halton"] = "random"
    split: Split = Split()
    codec: Codec = "zlib"


class Recipe(Section):
    """A corpus, from its bearings to its files."""

    name: Name
    title: Annotated[str, StringConstraints(min_length=1, max_length=200)]
    seed: Annotated[StrictInt, Field(ge=0, lt=2**63)] = 0
    corpus: CorpusSection
    recording: Recording
    bearing: Annotated[CatalogueBearing | GeometryBearing, Field(discriminator="kind")]
    machine: Machine = Machine()
    contact: Contact = Contact()
    specimen: Specimen = Specimen()
    operation: Operation
    faults: Annotated[tuple[Fault, ...], Field(min_length=1)]
    path: Path = Path()
    background: Background = Background()
    level: Annotated[PhysicalLevel | SnrLevel, Field(discriminator="kind")] = PhysicalLevel()
    records: Annotated[StrictInt, Field(ge=1)] | None = None
    """Number of records if the corpus is to end early."""

    def __hash__(self) -> int:
        """Equal recipes have one name and seed; pydantic's own hash fails on the dictionaries of some sections."""
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
        """Check counts and sizes before anything is drawn: the limits keep what a part takes to a few gigabytes."""
        corpus, recording = self.corpus, self.recording
        whole = corpus.rigs * corpus.specimens_per_rig * corpus.records_per_specimen
        # also where records: ends the corpus early, since the splits are drawn over all of its rigs
        place = "corpus: rigs * specimens_per_rig * records_per_specimen"
        check_limit("records", whole, f"{place} are", ValueError)
        check_limit("rig_specimens", corpus.specimens_per_rig, "corpus.specimens_per_rig: asks for", ValueError)
        seconds = recording.settle_s + recording.duration_s
        samples = round(seconds * recording.sample_rate_hz) * len(recording.channels)
        check_limit(
            "record_samples", samples, "recording: a record of all channels, what settles included, has", ValueError
        )
        records = min(self.n_records, corpus.records_per_part)
        needed = samples + _SAMPLES_OF_A_RECORD + _SAMPLES_OF_A_NUMBER * self._numbers_of_a_record()
        check_limit("part_samples", records * needed, f"corpus.records_per_part: {records} records need", ValueError)
        return self

    def _numbers_of_a_record(self) -> int:
        """How many numbers of profiles and traces every record is given."""
        profiles = (self.operation.speed_profile, self.operation.load_profile)
        tables = sum(2 * len(profile.times_s) for profile in profiles if isinstance(profile, Table))
        traces = [0]
        for fault in self.faults:
            parts = fault.parts if isinstance(fault, CompoundFault) else (fault,)
            spalled = [part for part in parts if isinstance(part, RaceFault | BallFault)]
            traces.append(sum(round(part.spalls.support()[1]) * len(part.trace_um or ()) for part in spalled))
        return tables + max(traces)

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
            raise ValueError(
                "corpus.split: validation and test leave nothing to train on; let them add up to less than 1."
            )
        if self.machine.resonator is None and any("sensor" in channel.body for channel in self.recording.channels):
            raise ValueError("recording.channels: body sensor needs machine.resonator; give one, or use body: housing.")
        for place, path in [
            ("path", self.path),
            *((f"recording.channels[{n}].path", c.path) for n, c in enumerate(self.recording.channels)),
        ]:
            if path is not None and path.silent():
                raise ValueError(
                    f"{place}.direct: 0 without modes lets nothing through; give modes or a direct part above 0."
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
                "operation.temperature_celsius: does nothing without oil; give contact.lubricant, or leave it out."
            )
        for key, profile in (("speed", self.operation.speed_profile), ("load", self.operation.load_profile)):
            if isinstance(profile, Steps) and profile.step_s * len(profile.levels_percent) > self.recording.duration_s:
                raise ValueError(
                    f"operation.{key}_profile.step_s: {profile.step_s:g} s leaves the levels no time; keep it below "
                    f"{self.recording.duration_s / len(profile.levels_percent):.3g}."
                )
        if len({channel.name for channel in self.recording.channels}) < len(self.recording.channels):
            raise ValueError("recording.channels: two channels have one name; give each its own.")
        return self

    def _slanted(self) -> bool:
        """Whether some bearing has a contact angle."""
        angles = {0.0, *self.specimen.contact_angle_deg.support()}
        if isinstance(self.bearing, CatalogueBearing):
            angles |= {self.bearing.bearing(designation).contact_angle for designation in self.bearing.designations}
        else:
            angles |= set(self.bearing.contact_angle_deg.support())
        return angles != {0.0}
