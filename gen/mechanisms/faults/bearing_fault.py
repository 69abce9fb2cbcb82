"""What a fault of a bearing is: the keys that a recipe gives, and what a drawn one does to the bearing."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from gen.corpus.schema import Variable
from gen.drawing import Section
from gen.physics.bearing import Bearing
from gen.physics.kernel_input import Spall

BALL_SPACING, RACES = "ball_spacing_mm", ("inner", "outer")


class BearingFault(Section):
    """A fault of one part of a bearing."""

    drawn_per = "specimen"
    labels: ClassVar[tuple[Variable, ...]] = ()
    """Variables of the corpus that tell its size, 0 without the fault."""
    sizes: ClassVar[tuple[str, ...]] = ()
    """Keys of which a share of its severity is a share."""
    lines: ClassVar[Mapping[str, tuple[str, int]]] = {}
    """Nominal order at which damage of a part repeats, and its multiple; none if it hits nothing."""

    if TYPE_CHECKING:
        kind: Any

    @property
    def part(self) -> Any:
        """Damaged part."""
        return getattr(self, "site", self.kind)

    @property
    def components(self) -> "tuple[BearingFault, ...]":
        """Faults of one part each."""
        return (self,)

    @property
    def n_numbers(self) -> int:
        """Count of the numbers of traces that each record holds."""
        return 0

    def at_severity(self, share: float) -> Self:
        """The same drawn fault with a share of its sizes."""
        scaled = {key: _times(share, getattr(self, key)) for key in self.sizes if getattr(self, key) is not None}
        return self.model_copy(update=scaled)

    def check(self, bearing: Bearing, item: str) -> None:
        """RecipeError if the drawn fault of an ``item`` does not fit its bearing."""

    def spalls(self, load_angle: float) -> list[Spall]:
        """Spalls of the part, those of the outer race with their angles from the x axis; ``load_angle`` is that of the load [rad]."""
        return []

    def turning(self) -> Mapping[str, float]:
        """Fields of :class:`gen.physics.kernel_input.Turning` that differ from those of a sound bearing."""
        return {}


class Healthy(BearingFault):
    """A bearing without a fault."""

    kind: Literal["healthy"]
    """Leaves the bearing undamaged."""

    @property
    def components(self) -> tuple[BearingFault, ...]:
        """None."""
        return ()


def _times(share: float, value: Any) -> Any:
    return tuple(share * item for item in value) if isinstance(value, tuple) else share * value
