"""The recipe: what a corpus is made of, frozen once it is read.

Keys end in their unit; every number may be a distribution. What is drawn once per machine, per bearing and per record stands in
sections of its own. :func:`split_unit` is the one place where human units become SI.
"""

import math
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictInt,
    StringConstraints,
    ValidationInfo,
    field_validator,
    model_validator,
)

from gen.corpus import Codec
from gen.distributions import Distribution, Number, check_bounds, within
from gen.physics.catalogue import BALL_BEARINGS
from gen.physics.kernel import MAX_BALLS

_UNITS = {
    "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "rpm": 1 / 60, "deg": math.pi / 180, "percent": 1e-2, "mm_s": 1e-3,
    "hz": 1.0, "s": 1.0, "kg": 1.0, "n": 1.0, "m_s2": 1.0, "n_m": 1.0, "n_s_m": 1.0, "db": 1.0,
}  # fmt: skip

MAX_OVERSAMPLING = 96
MAX_SPALLS = 16
Weight = Annotated[Number, Field(ge=0)]
Count = Annotated[StrictInt, Field(ge=1)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_.-]{1,64}$")]


Body = Literal["shaft", "housing", "sensor"]


def _certain(value: Any) -> Any:
    return {value: 1.0} if isinstance(value, str) else value


def split_unit(key: str) -> tuple[str, float]:
    """Key without its unit, and the factor that turns that unit into SI.

    >>> split_unit("width_mm"), split_unit("balance_mm_s"), split_unit("direct")
    (('width', 0.001), ('balance', 0.001), ('direct', 1.0))
    """
    words = key.split("_")
    for length in (3, 2, 1):
        unit = "_".join(words[-length:])
        if len(words) > length and unit in _UNITS:
            return "_".join(words[:-length]), _UNITS[unit]
    return key, 1.0


class Section(BaseModel):
    """A part of a recipe: frozen, with no key it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True)

    @field_validator("*")
    @classmethod
    def _within_bounds(cls, value: Any, info: ValidationInfo) -> Any:
        bounds = cls.model_fields[info.field_name or ""].json_schema_extra
        return check_bounds(value, bounds) if isinstance(bounds, dict) else value


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


class Converter(Section):
    """A 16-bit analogue-to-digital converter."""

    kind: Literal["adc"] = "adc"
    full_scale_m_s2: Annotated[Number, Field(gt=0, le=1e6)] = 500.0


class FloatConverter(Section):
    """No converter: 32-bit floating point."""

    kind: Literal["float32"]


class Channel(Section):
    """What a channel measures: the acceleration of a body along a direction.

    ``body`` is a body, or the weight of each where it is drawn per rig. ``sensor`` is the mass on the sensor resonance.
    """

    name: Name
    body: Annotated[dict[Body, Weight], BeforeValidator(_certain, json_schema_input_type=Body | dict[Body, Weight])] = {
        "sensor": 1.0
    }
    angle_deg: Distribution = within(-360, 360, default=90.0)


class Recording(Section):
    """Sample rate, length and channels of every record."""

    sample_rate_hz: Annotated[Number, Field(ge=1000, le=200_000)]
    duration_s: Annotated[Number, Field(gt=0, le=600)]
    settle_s: Annotated[Number, Field(ge=0.05, le=10)] = 0.2
    """Simulated before the record starts, and dropped."""
    oversampling: Annotated[StrictInt, Field(ge=1, le=MAX_OVERSAMPLING)] | None = None
    """Steps per sample; by default as many as the stiffest mode of the record needs."""
    channels: Annotated[tuple[Channel, ...], Field(min_length=1, max_length=6)] = (Channel(name="sensor"),)
    converter: Annotated[Converter | FloatConverter, Field(discriminator="kind")] = Converter()


class CatalogueBearing(Section):
    """One of the bearings of the catalogue, drawn per rig."""

    kind: Literal["catalogue"]
    designations: Annotated[tuple[Literal[BALL_BEARINGS], ...], Field(min_length=1)]  # type: ignore[valid-type]


class GeometryBearing(Section):
    """A bearing given by its geometry, each number drawn per rig; ``ball_share`` is ball over pitch diameter."""

    kind: Literal["geometry"]
    designation: Name = "geometry"
    n_balls: Distribution = within(5, MAX_BALLS)
    pitch_mm: Distribution = within(5, 1000, open_low=True)
    ball_share: Distribution = within(0.05, 0.45)
    contact_angle_deg: Distribution = within(-40, 40, default=0.0)


class Resonator(Section):
    """Mass on a spring between housing and sensor."""

    mass_kg: Distribution = within(0, 10, open_low=True, default=0.2)
    frequency_hz: Distribution = within(100, 50_000, default=3000.0)
    damping_percent: Distribution = within(0.1, 50, default=3.0)


class Machine(Section):
    """Masses, springs and dampers, drawn per rig."""

    shaft_mass_kg: Distribution = within(0, 1000, open_low=True, default=5.5)
    housing_mass_kg: Distribution = within(0, 1000, open_low=True, default=3.0)
    support_frequency_hz: Distribution = within(10, 5000, default=423.0)
    support_damping_percent: Distribution = within(0.1, 100, default=5.0)
    support_ratio: Distribution = within(0.1, 10, default=1.0)
    ring_damping_n_s_m: Distribution = within(0, 1e5, default=1000.0)
    ring_stiffness_n_m: Distribution = within(0, 1e9, default=0.0)
    shaft_damping_n_s_m: Distribution = within(0, 1e5, default=200.0)
    shaft_stiffness_n_m: Distribution = within(0, 1e9, default=0.0)
    contact_damping_n_s_m: Distribution = within(0, 1e4, default=0.0)
    balance_mm_s: Distribution = within(0, 100, default=1.0)
    load_angle_deg: Distribution = within(-360, 360, default=-90.0)
    resonator: Resonator | None = Resonator()


class Modes(Section):
    """Resonances: how many, where, how damped, and how strong beside the direct part."""

    count: Distribution = within(0, 16)
    frequency_hz: Distribution = within(10, 50_000)
    damping_percent: Distribution = within(0.05, 50)
    gain_db: Distribution = within(-80, 80, default=0.0)


class Path(Section):
    """Linear path from bearing to sensor, drawn per rig: a direct part and base-excited resonances with random signs."""

    direct: Distribution = within(0, 10, default=1.0)
    modes: Modes | None = None
    modulation: "Modulation | None" = None


class Modulation(Section):
    """Amplitude modulation at one and two times the shaft rate, in a share of the rigs."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    first: Distribution = within(0, 1)
    second: Distribution = within(0, 1)


class Harmonics(Section):
    """Lines at multiples of the shaft rate, in a share of the rigs; levels are relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    count: Distribution = within(1, 64)
    level_db: Distribution = within(-80, 40)


class Tones(Section):
    """Lines at fixed frequencies, in a share of the rigs; levels are relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    count: Distribution = within(1, 64)
    frequency_hz: Distribution = within(1, 100_000)
    level_db: Distribution = within(-80, 40)
    modulation: Distribution = within(0, 1, default=0.0)


class Impulses(Section):
    """Ringing impulses that no fault causes, at random times; levels are peaks relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    rate_hz: Distribution = within(0.1, 1000)
    level_db: Distribution = within(-80, 60)


class Knocks(Section):
    """Ringing impulses locked to the shaft; levels are peaks relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    orders: Distribution = within(0.1, 20)
    level_db: Distribution = within(-80, 60)


class Background(Section):
    """What the machine sounds like without the bearing: drawn per rig, on healthy and faulty records alike."""

    slope: Distribution = within(-2, 4, default=0.0)
    floor_db: Distribution = within(-120, 20, default=-40.0)
    modes: Modes | None = None
    modulation: Modulation | None = None
    harmonics: Harmonics | None = None
    tones: Tones | None = None
    impulses: Impulses | None = None
    knocks: Knocks | None = None


class PhysicalLevel(Section):
    """The bearing as it was simulated, times a gain drawn per rig, over a background of drawn rms."""

    kind: Literal["physical"] = "physical"
    gain: Distribution = within(0, 1000, open_low=True, default=1.0)
    background_m_s2: Distribution = within(0, 1000, default=0.3)


class SnrLevel(Section):
    """Bearing over background by a drawn ratio, and the whole record at a drawn rms, so that no level gives the class away."""

    kind: Literal["snr"]
    faulty_db: Distribution = within(-60, 60)
    healthy_db: Distribution = within(-60, 60)
    rms_m_s2: Distribution = within(0, 1000, open_low=True, default=5.0)


class Operation(Section):
    """How the machine runs, drawn per record."""

    shaft_rpm: Distribution = within(1, 100_000)
    label_error_percent: Distribution = within(-50, 50, default=0.0)
    load_n: Distribution = within(1, 1e7, default=300.0)
    speed_wander_percent: Distribution = within(0, 10, default=0.1)
    mean_slip_percent: Distribution = within(-10, 20, default=0.0)
    slip_percent: Distribution = within(0, 10, default=1.0)
    jitter_deg: Distribution = within(0, 5, default=0.3)


class Specimen(Section):
    """How one physical bearing differs from its drawing."""

    diametral_clearance_um: Distribution = within(-60, 500, default=10.0)
    inner_conformity: Distribution = within(0.505, 0.6, default=0.52)
    outer_conformity: Distribution = within(0.505, 0.6, default=0.52)
    waviness_nm: Distribution = within(0, 10_000, default=0.0)
    contact_angle_deg: Distribution = within(0, 30, default=0.0)
    """Contact angle beyond that of the drawing, as axial load brings it about: nominal orders do not know it."""


class Healthy(Section):
    """A bearing without a fault."""

    kind: Literal["healthy"]
    weight: Weight = 1.0


class RaceFault(Section):
    """Spalls on a race; the angle of an outer race spall counts from the load direction."""

    kind: Literal["inner", "outer"]
    weight: Weight = 1.0
    spalls: Distribution = within(1, MAX_SPALLS, default=1)
    width_mm: Distribution = within(0, 20, open_low=True)
    depth_um: Distribution = within(0, 5000, open_low=True, default=280.0)
    angle_deg: Distribution = within(-360, 360, default=0.0)
    profile: Literal["geometric", "half_sine", "raised_cosine", "rectangular"] = "geometric"


class BallFault(Section):
    """Spalls on a ball, whose spin axis wanders about an offset; beyond ``track_deg`` the spall misses the track."""

    kind: Literal["ball"]
    weight: Weight = 1.0
    spalls: Distribution = within(1, MAX_SPALLS, default=1)
    width_mm: Distribution = within(0, 20, open_low=True)
    depth_um: Distribution = within(0, 5000, open_low=True, default=280.0)
    angle_deg: Distribution = within(-360, 360, default=0.0)
    profile: Literal["geometric", "half_sine", "raised_cosine", "rectangular"] = "geometric"
    track_deg: Distribution = within(0, 90, default=8.6)
    axis_offset_deg: Distribution = within(-90, 90, default=0.0)
    axis_wander_deg: Distribution = within(0, 180, default=0.0)
    spin_wander_percent: Distribution = within(0, 20, default=0.0)


Fault = Annotated[Healthy | RaceFault | BallFault, Field(discriminator="kind")]


class Recipe(Section):
    """A corpus, from its bearings to its files."""

    name: Name
    title: Annotated[str, StringConstraints(min_length=1, max_length=200)]
    seed: Annotated[StrictInt, Field(ge=0, lt=2**63)] = 0
    corpus: CorpusSection
    recording: Recording
    bearing: Annotated[CatalogueBearing | GeometryBearing, Field(discriminator="kind")]
    machine: Machine = Machine()
    specimen: Specimen = Specimen()
    operation: Operation
    faults: Annotated[tuple[Fault, ...], Field(min_length=1)]
    path: Path = Path()
    background: Background = Background()
    level: Annotated[PhysicalLevel | SnrLevel, Field(discriminator="kind")] = PhysicalLevel()
    records: Annotated[StrictInt, Field(ge=1)] | None = None
    """Number of records if the corpus is to end early."""

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
    def _can_be_made(self) -> Self:
        kinds = {fault.kind for fault in self.faults if fault.weight > 0}
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
        silent = self.path.direct.support()[1] == 0 and (
            self.path.modes is None or self.path.modes.count.support()[0] < 1
        )
        if silent:
            raise ValueError(
                "path.direct: 0 without modes lets nothing through; give path.modes or a direct part above 0."
            )
        if self.n_samples < 16:
            raise ValueError(f"recording.duration_s: {self.n_samples} samples are too few; use at least 16.")
        if len({channel.name for channel in self.recording.channels}) < len(self.recording.channels):
            raise ValueError("recording.channels: two channels have one name; give each its own.")
        return self
