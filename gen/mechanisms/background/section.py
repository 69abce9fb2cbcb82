"""Background of a machine: its noise, and the sources that it can have beside it.

Harmonics, tones, impulses and knocks are drawn from the stream of the rig. Sources that are locked to the shaft came later: they have
streams of their own, and a further one moves no value of the others.
"""

from collections.abc import Callable, Iterable, Iterator
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from gen.drawing import Drawn, Draws, Purpose, Section
from gen.mechanisms.background.gear_mesh import GearMesh
from gen.mechanisms.background.harmonics import Harmonics
from gen.mechanisms.background.impulses import Impulses
from gen.mechanisms.background.knocks import Knocks
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.background.machine_conditions import MachineConditions
from gen.mechanisms.background.noise import Noise
from gen.mechanisms.background.source import BackgroundSource, LockedSource
from gen.mechanisms.background.tones import Tones
from gen.mechanisms.mechanism import section_with
from gen.mechanisms.path import draw_modes, draw_modulation

SOURCES: tuple[type[BackgroundSource], ...] = (Harmonics, Tones, Impulses, Knocks)
"""Sources of the stream of a rig, in the order in which they are drawn."""
LOCKED: tuple[type[LockedSource], ...] = (GearMesh, MachineConditions, Looseness)
"""Sources that follow from the angle of the shaft, in the order in which they are added."""
if TYPE_CHECKING:

    class BackgroundSection(Noise):
        """Vibration of the machine without the bearing."""

        harmonics: Harmonics | None = None

else:
    _OF_BACKGROUND = [source for source in (*SOURCES, *LOCKED) if source is not MachineConditions]  # it has a section
    BackgroundSection = section_with("BackgroundSection", __name__, Noise, _OF_BACKGROUND)
KEYS = frozenset({*Noise.model_fields, "floor", "growth", *(source.place for source in (*SOURCES, *LOCKED))})
"""Names of the drawn values of a background."""


def draw_background(section: BackgroundSection, draws: Draws) -> Drawn:
    """Noise and sources of a rig but those that are locked to the shaft; levels are ratios of rms."""
    drawn: Drawn = {"slope": draws.value(section.slope), "floor": draws.ratio(section.floor_db)}
    for source in SOURCES:
        wanted = getattr(section, source.place)
        drawn[source.place] = None if wanted is None else wanted.draw(draws)
    return drawn | {"modes": draw_modes(draws, section.modes), "modulation": draw_modulation(draws, section.modulation)}


def draw_later(section: BackgroundSection, draws: Draws) -> Drawn:
    """Keys that came later and are drawn behind all others of a rig."""
    harmonics = section.harmonics
    coherence = draws.value(section.coherence)
    return {"coherence": coherence, "growth": 0.0 if harmonics is None else draws.value(harmonics.growth)}


def draw_locked(sections: Iterable[Section], stream_for: Callable[[Purpose], np.random.Generator], rig: int) -> Drawn:
    """Sources of a rig that are locked to the shaft, of the sections that have them; each from a stream of its own."""
    drawn: Drawn = dict.fromkeys(source.place for source in LOCKED)
    for section, source in product(sections, LOCKED):
        wanted = getattr(section, source.place, None)
        if wanted is not None:
            drawn[source.place] = wanted.draw(Draws(stream_for(source.of_rig), rig, f"rig {rig}"))
    return drawn


def locked_of(background: Drawn) -> Iterator[tuple[type[LockedSource], Drawn]]:
    """Sources of a drawn background that are locked to the shaft, with their values."""
    return ((source, drawn) for source in LOCKED if (drawn := background.get(source.place)) is not None)


def labels_of(background: Drawn) -> dict[str, float]:
    """Values of the labels of the sources that a drawn background has; a later source may change a label of an earlier one."""
    return {label.name: label.column([drawn])[0] for source, drawn in locked_of(background) for label in source.labels}
