"""Dataclasses of a scenario: the rig with its background, the specimen with its damage, the record with its conditions.

Every value is a number, a text or a tuple, in SI units, so that a corpus can store the scenario of each record as JSON.
"""

from dataclasses import dataclass, field, replace
from enum import IntEnum
from typing import Literal

import numpy as np

from gen.physics.bearing import Bearing
from gen.physics.profile import Profile

Drawn = dict[str, float]
"""Values drawn from one recipe section, by the key without its unit."""


class Purpose(IntEnum):
    """Purpose of a random stream; the number is part of the seed of the stream and must not change."""

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
    EDGES = 20
    AXIS = 21
    SLIP = 22


@dataclass(frozen=True)
class Spall:
    """Drawn dimensions of one spall."""

    site: Literal["inner", "outer", "ball"]
    width: float
    """Along the rolling direction [m]."""
    depth: float
    """[m]."""
    angle: float
    """Angle [rad]; on the outer race it counts from the direction of the load."""
    ball: int = 0
    """Number of the damaged ball, if ``site`` is ``ball``."""
    profile: Literal["geometric", "half_sine", "raised_cosine", "rectangular", "trace"] = "geometric"
    trace: tuple[float, ...] = ()
    """Depths of a measured surface from edge to edge, evenly spaced [m]."""
    roughness: float = 0.0
    """Rms roughness of the floor [m]."""
    scatter: float = 0.0
    """Standard deviation of the logarithm of the drop from passage to passage [1]."""


@dataclass(frozen=True)
class Wear:
    """Waviness of a worn race."""

    site: Literal["inner", "outer"]
    waviness: float
    """Rms [m]."""
    order: int | None
    """Waves per turn; None for all orders, with amplitudes proportional to 1/order."""


@dataclass(frozen=True)
class Mode:
    """A resonance."""

    frequency: float
    """[Hz]."""
    damping: float
    """Damping ratio [1]."""
    gain: float
    """Amplitude with its sign [1]."""


@dataclass(frozen=True)
class Tone:
    """A spectral line, or a series of impulses."""

    frequency: float
    """[Hz], or orders of the shaft for harmonics and knocks; of impulses the mean rate [Hz]."""
    level: float
    """Rms of the line, or peak of an impulse, over the rms of the noise [1]."""
    modulation: float = 0.0
    """Depth of the amplitude modulation once per turn of the shaft [1]."""


@dataclass(frozen=True)
class ShaftModulation:
    """Depth of an amplitude modulation once and twice per turn of the shaft [1]."""

    once: float = 0.0
    twice: float = 0.0


@dataclass(frozen=True)
class Pickup:
    """Body and direction of the acceleration that a channel measures."""

    body: Literal["shaft", "housing", "sensor"]
    angle: float
    """Direction [rad]."""


@dataclass(frozen=True)
class Path:
    """Transfer path from bearing to sensor: a direct part, resonances, and modulation by the shaft."""

    direct: float
    """Gain of the part without resonance [1]."""
    modes: tuple[Mode, ...]
    modulation: ShaftModulation


@dataclass(frozen=True)
class Background:
    """Vibration of the machine without the bearing; levels are relative to the rms of its noise."""

    slope: float
    """The PSD of the noise falls as ``f**-slope`` [1]."""
    floor: float
    """Amplitude of the white floor of the noise [1]."""
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
    """Transfer path of each channel; None for a channel on the common ``path``."""
    background: Background
    gain: float
    """Gain of bearing and background, for ``level.kind: physical`` [1]."""
    background_rms: float
    """Rms of the background before the gain, for ``level.kind: physical`` [m s-2]."""
    lubricant: Drawn | None = None
    footprint: bool = False
    """True for contacts of Hertzian width, False for point contacts."""
    ball_mass: bool = False
    """True if the mass of the balls strikes the edges of spalls."""


@dataclass(frozen=True)
class Specimen:
    """One physical bearing."""

    number: int
    bearing: Bearing
    properties: Drawn
    fault: str
    spalls: tuple[Spall, ...]
    axis: Drawn
    """Tilt of the spin axis of a damaged ball [rad]: mean, rms, and tilt beyond which the spall misses the track; probability [1] and
    spread [rad] of its jumps."""
    split: str
    cage: Drawn = field(default_factory=dict)
    """Pitch error [rad] and knock [N] of a broken cage."""
    wear: Wear | None = None


@dataclass(frozen=True)
class Operation:
    """Operating conditions and level of one record."""

    number: int
    conditions: Drawn
    snr: float | None
    """Bearing over background, for ``level.kind: snr`` [dB]."""
    rms: float | None
    """Rms of bearing and background together, for ``level.kind: snr`` [m s-2]."""
    speed_profile: Profile | None = None
    load_profile: Profile | None = None


@dataclass(frozen=True)
class Scenario:
    """All drawn values of one record."""

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
    """Random stream of one purpose; a stream of a rig or a specimen has 0 for the numbers of the lower levels."""
    sequence = np.random.SeedSequence(seed, spawn_key=(rig, specimen, record, int(purpose)))
    return np.random.Generator(np.random.PCG64DXSM(sequence))
