"""Background of a machine: its noise, and the sources that it can have beside it."""

from typing import TYPE_CHECKING, Any

from gen.mechanisms.background.bursts import Bursts
from gen.mechanisms.background.gear_mesh import GearMesh
from gen.mechanisms.background.impulses import Impulses, Knocks
from gen.mechanisms.background.machine_conditions import CONDITIONS
from gen.mechanisms.background.noise import Noise
from gen.mechanisms.background.recorded_background import RecordedBackground
from gen.mechanisms.background.shaft_lines import Harmonics
from gen.mechanisms.background.source import BackgroundSource, MachineCondition, MachineSource
from gen.mechanisms.background.tones import Tones
from gen.mechanisms.mechanism import mechanisms_of, section_with, with_plugins

SOURCES: tuple[type[BackgroundSource], ...] = (RecordedBackground, Tones)
"""Sources that the measurement adds."""
_KEYS = (*Noise.model_fields, *(source.place for source in SOURCES))
_OF_MACHINE = [
    source
    for source in with_plugins(MachineSource, (Harmonics, Impulses, Knocks, GearMesh, Bursts), _KEYS)
    if not issubclass(source, MachineCondition)
]
MACHINE_SOURCES: tuple[type[MachineSource], ...] = (*_OF_MACHINE, *CONDITIONS)
"""Sources whose vibration is computed ahead of the paths, in the order in which they are added."""

if TYPE_CHECKING:

    class BackgroundSection(Noise):
        """Vibration of the machine without the bearing."""

        def __getattr__(self, source: str) -> Any: ...

else:
    BackgroundSection = section_with("BackgroundSection", __name__, Noise, (*SOURCES, *_OF_MACHINE))


def machine_sources_of(recipe: Any) -> list[MachineSource]:
    """Sources of a drawn recipe whose vibration is computed ahead of the paths."""
    there = (*mechanisms_of(recipe.background), *mechanisms_of(recipe.machine_conditions))
    return [source for source in there if isinstance(source, MachineSource)]
