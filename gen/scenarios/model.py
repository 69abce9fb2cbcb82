"""Dataclasses of a scenario: the rig, the specimen with its damage, the record with its conditions; and random streams.

Every value is a number, a text or a tuple, in SI units, so that a corpus can store the scenario of each record as JSON.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from gen.drawing import Drawn, Purpose, stream
from gen.mechanisms.faults import LABELS
from gen.mechanisms.faults.bearing_fault import Damage, Spall
from gen.physics.bearing import Bearing
from gen.physics.profile import Profile
from gen.recipe import MAX_OVERSAMPLING
from gen.support.shown import Shown

Number = Annotated[int, Field(ge=0, lt=2**31)]
"""Number of a rig, specimen or record."""
_SIZES = {label.name for label in LABELS}


@dataclass(frozen=True)
class Settings:
    """Values that a recipe fixes for all of its records; with them a scenario is simulated, measured and labelled without the recipe."""

    recipe: str
    """Name of the recipe."""
    corpus: str
    """First part of the ``identity`` of its records."""
    seed: Annotated[int, Field(ge=0, lt=2**63)]
    """Start of all random streams."""
    sample_rate: Annotated[float, Field(ge=1000, le=200_000)]
    """[Hz]."""
    samples: Annotated[int, Field(ge=1)]
    """Number of samples of a record."""
    settle: Annotated[float, Field(ge=0, le=10)]
    """Time before the record in which the response settles [s]."""
    oversampling: Annotated[int, Field(ge=1, le=MAX_OVERSAMPLING)] | None
    """Steps per sample; None if the stiffest mode of each record decides."""
    channels: Annotated[tuple[str, ...], Field(min_length=1)]
    """Name of each channel."""
    full_scale: Annotated[float, Field(gt=0)] | None
    """Largest acceleration of the converter [m s-2]; None without one."""
    twins: bool
    """Whether records with a fault are also simulated without it."""
    undetected: Literal["redraw", "keep", "healthy"]
    """``healthy`` if a record in which its fault cannot be seen is labelled healthy."""


@dataclass(frozen=True)
class Pickup:
    """Body and direction of the acceleration that a channel measures."""

    body: Literal["shaft", "housing", "sensor"]
    angle: float
    """Direction [rad]."""


@dataclass(frozen=True)
class Rig:
    """One machine."""

    number: Number
    bearing: Bearing
    machine: Drawn
    resonator: Drawn | None
    channels: tuple[Pickup, ...]
    path: Drawn
    own_paths: tuple[Drawn | None, ...]
    """Transfer path of each channel; None for a channel on the common ``path``."""
    background: Drawn
    """Noise and sources; levels are relative to the rms of the noise [1]."""
    gain: float
    """Gain of bearing and background, for ``level.kind: physical`` [1]."""
    background_rms: float
    """Rms of the background before the gain, for ``level.kind: physical`` [m s-2]."""
    lubricant: Drawn | None = None
    footprint: bool = False
    """True for contacts of Hertzian width, False for point contacts."""
    sensor_faults: Drawn = field(default_factory=dict)
    """Faults of the measuring chain that last as long as the rig."""
    high_pass: float = 0.0
    """Frequency below which the sensors measure less and less; 0 if they measure down to 0 Hz [Hz]."""
    offset: float = 0.0
    """Constant that amplifier and converter add [m s-2]."""


@dataclass(frozen=True)
class Specimen:
    """One physical bearing."""

    number: Number
    bearing: Bearing
    properties: Drawn
    fault: str
    spalls: tuple[Spall, ...]
    damage: Damage
    split: str
    fault_try: int = 0
    """Number of faults that were drawn before this one and could not be seen."""
    entry: int = 0
    """Place of the fault in ``faults`` of the recipe."""

    @property
    def damaged_parts(self) -> list[str]:
        """Parts that are damaged, each once; the tilt of the spin axis of a ball is no damage without a spall."""
        others = (drawn.get("site", kind) for kind, drawn in self.damage.items() if _SIZES & drawn.keys())
        return list(dict.fromkeys([*(spall.site for spall in self.spalls), *others]))

    def at_severity(self, share: float) -> "Specimen":
        """The same bearing with a share of its damage: of width and depth of spalls, and of what labels tell.

        0 is the bearing before it was damaged.
        """
        if share == 1:
            return self
        if share == 0:
            return replace(self, fault="healthy", spalls=(), damage={})
        damage = {
            kind: drawn | {name: share * drawn[name] for name in _SIZES & drawn.keys()}
            for kind, drawn in self.damage.items()
        }
        return replace(self, spalls=tuple(spall.at_severity(share) for spall in self.spalls), damage=damage)


@dataclass(frozen=True)
class Gains:
    """Factors of bearing and background [1]."""

    bearing: float
    background: float


@dataclass(frozen=True)
class Conditions:
    """Drawn values of the section ``operation`` [SI]; temperature in degrees Celsius."""

    shaft_rate: float
    label_error: float
    load: float
    speed_wander: float
    mean_slip: float
    slip: float
    jitter: float
    spin_wander: float
    axial_load: float
    load_wander: float
    temperature: float
    inner_ring_hotter: float
    slip_walk: float | None = None


@dataclass(frozen=True)
class Snapshot:
    """Place of a record in the life of its bearing; each value has the name of the variable in the corpus that it becomes."""

    age: float
    """[s]."""
    rul: float | None
    """Time left to the failure [s]; None if the test ended before it and its time is not known."""
    rul_revolutions: float | None
    event: int
    """1 if the bearing failed in its test, else 0."""
    initiation_time: float
    """Age at which the spall begins [s]."""
    spall_length: float
    """0 before it begins [m]."""
    spall_depth: float
    stage: int
    """0 before the spall begins, 1 while it grows, 2 beyond the critical length."""
    overloaded: int
    """1 if the load is above the validity of ISO 281."""
    first_detectable_time: float | None = None
    """Age at the first snapshot in which the spall can be seen [s]; None before the measurement, and if it is never seen."""


@dataclass(frozen=True)
class Operation:
    """Operating conditions and level of one record."""

    number: Number
    conditions: Conditions
    snr: float | None
    """Fault over all else, or bearing over background without a fault, for ``level.kind: snr`` [dB]."""
    rms: float | None
    """Rms of bearing and background together, for ``level.kind: snr`` [m s-2]."""
    speed_profile: Profile | None = None
    load_profile: Profile | None = None
    level_try: int = 0
    """Number of levels that were drawn before this one and at which the fault could not be seen."""
    sensor_faults: Drawn = field(default_factory=dict)
    """Faults of the measuring chain that come and go."""
    pair: int = -1
    """Number of the group of records that differ in the severity of their fault alone; -1 if the record is in no group."""
    rung: int = -1
    """Place of the severity in ``corpus.rungs``; -1 if the record is in no group."""
    gains: Gains | None = None
    """Gains in place of those that follow from ``snr`` and ``rms``: those of the largest severity of its group. None for a record in no
    group, and before the measurement."""
    narrowest_spall: Annotated[float, Field(gt=0)] | None = None
    """Width of the narrowest spall of its group [m]: the step of all records of the group follows it. None for a record in no group, and
    without spalls."""
    life: Snapshot | None = None
    """None in recipes without a life."""

    @property
    def stream_number(self) -> int:
        """Number of the record in its random streams: all records of a group have the streams of the first."""
        return self.number - max(self.rung, 0)


@dataclass(frozen=True, repr=False)
class Scenario(Shown):
    """All drawn values of one record, and the settings of its recipe."""

    settings: Settings
    rig: Rig
    specimen: Specimen
    record: Operation

    def _heading(self) -> str:
        numbers = f"rig {self.rig.number}, specimen {self.specimen.number}, record {self.record.number}"
        return f"Scenario of {self.settings.recipe}: {numbers}, {self.specimen.fault}"

    def _facts(self) -> Mapping[str, object]:
        conditions, bearing = self.record.conditions, self.specimen.bearing
        spalls = [
            f"spall of {1e3 * one.width:.3g} mm, {1e6 * one.depth:.3g} µm deep, in the {one.site}"
            for one in self.specimen.spalls
        ]
        return {
            "bearing": f"{bearing.designation}: {bearing.n_balls} {bearing.rolling_element}s of "
            f"{1e3 * bearing.ball_diameter:.4g} mm on {1e3 * bearing.pitch_diameter:.4g} mm",
            "damage": ", ".join(spalls or self.specimen.damaged_parts) or "none",
            "speed": f"{60 * conditions.shaft_rate:,.4g} rpm",
            "load": f"{conditions.load:,.4g} N",
            "record": f"{self.settings.samples / self.settings.sample_rate:g} s at {self.settings.sample_rate:,g} Hz",
            "next": "gen.simulate([scenario]), scenario.without_fault(), dataclasses.replace(scenario, ...)",
        }

    def rng(self, purpose: Purpose) -> np.random.Generator:
        """Random stream of this record for one purpose."""
        return stream(self.settings.seed, self.rig.number, self.specimen.number, self.record.stream_number, purpose)

    def without_fault(self) -> "Scenario":
        """The same record of the same specimen before it was damaged."""
        return replace(self, specimen=self.specimen.at_severity(0))
