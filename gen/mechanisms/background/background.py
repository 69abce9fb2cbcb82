"""Background of a machine: its noise, and the sources that it can have beside it."""

from typing import TYPE_CHECKING, Any

from gen.mechanisms.background.gear_mesh import GearMesh
from gen.mechanisms.background.impulses import Impulses, Knocks
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.background.machine_conditions import MachineConditions
from gen.mechanisms.background.noise import Noise
from gen.mechanisms.background.source import BackgroundSource, LockedSource
from gen.mechanisms.background.spectral_lines import Harmonics, Tones
from gen.mechanisms.mechanism import section_with, with_plugins

SOURCES: tuple[type[BackgroundSource], ...] = (Harmonics, Tones, Impulses, Knocks)
"""Sources that the measurement adds."""
LOCKED: tuple[type[LockedSource], ...] = with_plugins(LockedSource, (GearMesh, MachineConditions, Looseness))
"""Sources that follow from the angle of the shaft, in the order in which they are added."""

if TYPE_CHECKING:

    class BackgroundSection(Noise):
        """Vibration of the machine without the bearing."""

        def __getattr__(self, source: str) -> Any: ...

else:
    _OF_BACKGROUND = [source for source in (*SOURCES, *LOCKED) if source is not MachineConditions]  # it has a section
    BackgroundSection = section_with("BackgroundSection", __name__, Noise, _OF_BACKGROUND)


def locked_of(recipe: Any) -> list[LockedSource]:
    """Sources of a drawn recipe that are locked to the shaft."""
    places = [(section, source.place) for source in LOCKED for section in (recipe.background, recipe)]
    return [found for section, place in places if (found := getattr(section, place, None)) is not None]
