"""What a corpus is drawn into: rigs with their background, specimens with their spalls, records with their conditions.

Every value is plain and in SI units, so that a scenario can be stored beside its record and made again from it.
"""

from dataclasses import asdict, dataclass, replace
from enum import IntEnum
from typing import Any

import numpy as np

from gen.physics.batch import Spall
from gen.physics.bearing import Bearing

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
    direct: float
    modes: tuple[Mode, ...]
    modulation: tuple[float, float]
    background: Background
    gain: float
    background_rms: float


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


@dataclass(frozen=True)
class Operation:
    """One record: how the machine ran, and how loud the bearing was."""

    number: int
    conditions: Drawn
    snr: float | None
    rms: float | None


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
        return replace(self, specimen=replace(self.specimen, fault="healthy", spalls=()))


def stream(seed: int, rig: int, specimen: int, record: int, purpose: Purpose) -> np.random.Generator:
    """Random stream of one purpose at one place; levels above a record leave the lower numbers at 0."""
    sequence = np.random.SeedSequence(seed, spawn_key=(rig, specimen, record, int(purpose)))
    return np.random.Generator(np.random.PCG64DXSM(sequence))
