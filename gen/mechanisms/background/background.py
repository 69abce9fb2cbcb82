"""Background of a machine: its noise, and the sources that it can have beside it."""

from typing import TYPE_CHECKING, Any

from gen.mechanisms.background.gear_mesh import GearMesh
from gen.mechanisms.background.impulses import Impulses, Knocks
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.background.machine_conditions import MachineConditions
from gen.mechanisms.background.noise import Noise
from gen.mechanisms.background.source import BackgroundSource, MachineSource
from gen.mechanisms.background.spectral_lines import Harmonics, Tones
from gen.mechanisms.mechanism import section_with, with_plugins

SOURCES: tuple[type[BackgroundSource], ...] = (Harmonics, Tones, Impulses, Knocks)
"""Sources that the measurement adds."""
MACHINE_SOURCES: tuple[type[MachineSource], ...] = with_plugins(MachineSource, (GearMesh, MachineConditions, Looseness))
"""Sources whose vibration is computed ahead of the paths, in the order in which they are added."""

if TYPE_CHECKING:

    class BackgroundSection(Noise):
        """Vibration of the machine without the bearing."""

        def __getattr__(self, source: str) -> Any: ...

else:
    _OF_BACKGROUND = [
        source for source in (*SOURCES, *MACHINE_SOURCES) if source is not MachineConditions
    ]  # it has a section
    BackgroundSection = section_with("BackgroundSection", __name__, Noise, _OF_BACKGROUND)


def machine_sources_of(recipe: Any) -> list[MachineSource]:
    """Sources of a drawn recipe whose vibration is computed ahead of the paths."""
    places = [(section, source.place) for source in MACHINE_SOURCES for section in (recipe.background, recipe)]
    return [found for section, place in places if (found := getattr(section, place, None)) is not None]
