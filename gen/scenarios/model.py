"""Rigs with their background, specimens with their damage, records with their conditions.

Every value is plain and in SI units, so that a scenario can be stored with its record and read back.
"""

from dataclasses import dataclass, field, replace
from enum import IntEnum

import numpy as np

from gen.physics.bearing import Bearing
from gen.physics.profile import Profile

Drawn = dict[str, float]


class Purpose(IntEnum):
    """Purpose of a random stream."""

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


@dataclass(frozen=True)
class Spall:
    """One spall as it was drawn."""

    site: str
    """``inner``, ``outer`` or ``ball``."""
    width: float
    """Along the rolling direction [m]."""
    depth: float
    """[m]."""
    angle: float
    """On the outer race from the direction of the load [rad]."""
    ball: int = 0
    """Number of the ball that carries it, if ``site`` is ``ball``."""
    profile: str = "geometric"
    trace: tuple[float, ...] = ()
    """Depths of a measured surface from edge to edge [m]."""
    roughness: float = 0.0
    """Rms roughness of its floor [m]."""


@dataclass(frozen=True)
class Wear:
    """Waviness of a worn race: rms [m], at one ``order`` per turn, or with amplitudes that fall as 1/order."""

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
    """A spectral line: frequency [Hz or shaft orders], rms relative to the noise, and depth of its modulation by the shaft."""

    frequency: float
    level: float
    modulation: float = 0.0


@dataclass(frozen=True)
class ShaftModulation:
    """Depth of an amplitude modulation once and twice per turn of the shaft [1]."""

    once: float = 0.0
    twice: float = 0.0


@dataclass(frozen=True)
class Pickup:
    """The body whose acceleration a channel measures, and the direction in which it does [rad]."""

    body: str
    angle: float


@dataclass(frozen=True)
class Path:
    """Transfer path from bearing to sensor: a direct part, resonances, and modulation by the shaft."""

    direct: float
    modes: tuple[Mode, ...]
    modulation: ShaftModulation


@dataclass(frozen=True)
class Background:
    """Vibration of a machine without the bearing; levels are relative to its noise."""

    slope: float
    floor: float
    modes: tuple[Mode, ...]
    modulation: ShaftModulation
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
    channels: tuple[Pickup, ...]
    path: Path
    own_paths: tuple[Path | None, ...]
    """Path of each channel, None where it is the common one."""
    background: Background
    gain: float
    background_rms: float
    lubricant: Drawn | None = None
    footprint: bool = False
    """Whether contacts have their Hertzian width, or are points."""


@dataclass(frozen=True)
class Specimen:
    """One physical bearing."""

    number: int
    bearing: Bearing
    properties: Drawn
    fault: str
    spalls: tuple[Spall, ...]
    axis: Drawn
    """Tilt of the spin axis of a bearing with a ball spall: its mean, its rms, and the tilt that misses the track [rad]."""
    split: str
    cage: Drawn = field(default_factory=dict)
    """Pitch error [rad] and knock [N] of a broken cage."""
    wear: Wear | None = None


@dataclass(frozen=True)
class Operation:
    """One record: operating conditions, and level of the bearing."""

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
        """Random stream of this record for one purpose."""
        return stream(self.seed, self.rig.number, self.specimen.number, self.record.number, purpose)

    def without_fault(self) -> "Scenario":
        """The same record of the same specimen before it was damaged."""
        return replace(self, specimen=replace(self.specimen, fault="healthy", spalls=(), axis={}, cage={}, wear=None))


def stream(seed: int, rig: int, specimen: int, record: int, purpose: Purpose) -> np.random.Generator:
    """Random stream of one purpose at one place; levels above a record leave the lower numbers at 0."""
    sequence = np.random.SeedSequence(seed, spawn_key=(rig, specimen, record, int(purpose)))
    return np.random.Generator(np.random.PCG64DXSM(sequence))
