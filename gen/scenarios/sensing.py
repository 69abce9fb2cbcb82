"""Dataclasses of what the sensors of a rig measure beside its bearings: channels, transfer paths, background, faults of the chain."""

from dataclasses import dataclass
from typing import Literal

from gen.drawing.draws import Drawn


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
class Gear:
    """A gear on the shaft and its mate."""

    teeth: int
    mate_teeth: int
    lines: tuple[Drawn, ...]
    """Of each multiple of the mesh frequency: rms over that of the noise [1], and phase at shaft angle 0 [rad]."""
    shaft_modulation: float
    """Depth of the amplitude modulation once per turn of the shaft [1]."""
    mate_modulation: float
    """Depth of the amplitude modulation once per turn of the mate [1]."""
    phase_modulation: float
    """Peak of the phase modulation of the mesh once per turn of the shaft [rad]."""
    high_point: float
    """Shaft angle of the largest amplitude [rad]."""
    lead_point: float
    """Shaft angle at which the mesh is ahead by the peak of the phase modulation [rad]."""


@dataclass(frozen=True)
class ConditionSignal:
    """What a machine that is not well adds to the background."""

    kind: str
    order: float
    """Order of the shaft of which the lines are multiples [1]."""
    lines: tuple[Drawn, ...]
    """Of each multiple: rms over that of the noise [1], and phase at shaft angle 0 [rad]."""
    bursts: Drawn | None
    """Order of the shaft at which they come, rms over that of the noise [1], length and start [rad of a period]; None for none."""


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
    coherence: float = 0.0
    """Magnitude-squared coherence of the noise between two channels [1]."""
    growth: float = 0.0
    """The harmonics grow with the speed of a course to this power [1]."""
    gear: Gear | None = None
    condition: ConditionSignal | None = None
    """None for a machine that is sound."""
