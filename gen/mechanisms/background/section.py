"""Background of a machine: its noise, and the sources that it can have beside it."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

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

SOURCES: tuple[type[BackgroundSource], ...] = (Harmonics, Tones, Impulses, Knocks)
"""Sources that the measurement adds."""
LOCKED: tuple[type[LockedSource], ...] = (GearMesh, MachineConditions, Looseness)
"""Sources that follow from the angle of the shaft, in the order in which they are added."""

if TYPE_CHECKING:

    class BackgroundSection(Noise):
        """Vibration of the machine without the bearing."""

        harmonics: Harmonics | None = None
        tones: Tones | None = None
        impulses: Impulses | None = None
        knocks: Knocks | None = None

else:
    _OF_BACKGROUND = [source for source in (*SOURCES, *LOCKED) if source is not MachineConditions]  # it has a section
    BackgroundSection = section_with("BackgroundSection", __name__, Noise, _OF_BACKGROUND)


def locked_of(recipe: Any) -> Iterator[LockedSource]:
    """Sources of a drawn recipe that are locked to the shaft."""
    for source in LOCKED:
        found = getattr(recipe.background, source.place, None) or getattr(recipe, source.place, None)
        if found is not None:
            yield found
