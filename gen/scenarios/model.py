"""What a corpus is drawn into: rigs with their background, specimens with their spalls, records with their conditions.

Every value is plain and in SI units, so that a scenario can be stored beside its record and made again from it.
"""

from dataclasses import asdict, dataclass, field, replace
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from gen.physics.bearing import Bearing
from gen.physics.profile import Profile

Drawn = dict[str, float]


class Purpose(IntEnum):
    """What a random stream is for."""

    RIG = 0
    CLASSES = 1
    SPLIT = 2
    SPECIMEN = 3
    FAULT = 4
    WAVINESS = 5
    RECORD = 6
    MOTION = 7
    NOISE = 8
    SAMPLING = 9
    ROUGHNESS = 10
    WEAR = 11
    LOAD_WANDER = 12
    KNOCKS = 13


class Spall(NamedTuple):
    """One spall as it was drawn; ``ball`` says which ball carries it if ``site`` is ``ball``."""

    site: str
    width: float
    depth: float
    angle: float
    ball: int = 0
    profile: str = "geometric"
    trace: tuple[float, ...] = ()
    """Depths of a measured surface from edge to edge [m]."""
    roughness: float = 0.0
    """Of its floor, rms [m]."""


@dataclass(frozen=True)
class Wear:
    """Waviness of a worn race: rms [m], all of it at one ``order`` per turn, or falling as 1/order."""

    site: str
    waviness: float
    order: int | None


@dataclass(frozen=True)
class Mode:
    """A resonance: frequency [Hz], damping ratio and signed gain [1]."""

    frequency: float
    damping: float
    gain: float


@dataclass(frozen=True)
class Tone:
    """A line: frequency [Hz or shaft orders], rms relative to the noise, and depth of its modulation by the shaft."""

    frequency: float
    level: float
    modulation: float = 0.0


@dataclass(frozen=True)
class Path:
    """The way from bearing to sensor: a direct part, resonances, and modulation once and twice per turn of the shaft."""

    direct: float
    modes: tuple[Mode, ...]
    modulation: tuple[float, float]


@dataclass(frozen=True)
class Background:
    """What a machine sounds like without the bearing; levels are relative to its noise."""

    slope: float
    floor: float
    modes: tuple[Mode, ...]
    modulation: tuple[float, float]
    harmonics: tuple[Tone, ...]
    tones: tuple[Tone, ...]
    impulses: Tone | None
    knocks: Tone | None


@dataclass(frozen=True)
class Rig:
    """One machine."""

    number: int
    bearing: Bearing
    machine: Drawn
    resonator: Drawn | None
    channels: tuple[tuple[str, float], ...]
    """Body and direction [rad] of each channel."""
    path: Path
    own_paths: tuple[Path | None, ...]
    """Path of each channel that does not take the common one."""
    background: Background
    gain: float
    background_rms: float
    lubricant: Drawn | None = None
    footprint: bool = False
    """Whether contacts are as wide as Hertz says, or points."""


@dataclass(frozen=True)
class Specimen:
    """One physical bearing."""

    number: int
    bearing: Bearing
    properties: Drawn
    fault: str
    spalls: tuple[Spall, ...]
    """Outer race angles count from the load direction."""
    axis: Drawn
    split: str
    cage: Drawn = field(default_factory=dict)
    """Pitch error [rad] and knock [N] of a broken cage."""
    wear: Wear | None = None


@dataclass(frozen=True)
class Operation:
    """One record: how the machine ran, and how loud the bearing was."""

    number: int
    conditions: Drawn
    snr: float | None
    rms: float | None
    speed_profile: Profile | None = None
    load_profile: Profile | None = None


@dataclass(frozen=True)
class Scenario:
    """One record, fully drawn."""

    seed: int
    rig: Rig
    specimen: Specimen
    record: Operation

    def rng(self, purpose: Purpose) -> np.random.Generator:
        """Stream of this record for what is random in time."""
        return stream(self.seed, self.rig.number, self.specimen.number, self.record.number, purpose)

    def as_dict(self) -> dict[str, Any]:
        """Every drawn value, for storage."""
        return {"rig": asdict(self.rig), "specimen": asdict(self.specimen), "record": asdict(self.record)}

    def without_fault(self) -> "Scenario":
        """The same record of the same specimen before it was damaged."""
        return replace(self, specimen=replace(self.specimen, fault="healthy", spalls=(), axis={}, cage={}, wear=None))


def stream(seed: int, rig: int, specimen: int, record: int, purpose: Purpose) -> np.random.Generator:
    """Random stream of one purpose at one place; levels above a record leave the lower numbers at 0."""
    sequence = np.random.SeedSequence(seed, spawn_key=(rig, specimen, record, int(purpose)))
    return np.random.Generator(np.random.PCG64DXSM(sequence))
