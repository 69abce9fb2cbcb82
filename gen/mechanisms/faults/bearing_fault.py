"""What a fault of a bearing is: the keys that a recipe gives, and the damage that is drawn from them."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from gen.corpus.schema import Variable
from gen.drawing import Drawn, Draws, Known, Section
from gen.physics.bearing import Bearing, ball_spacing

BALL_SPACING, RACES = "ball_spacing_mm", ("inner", "outer")
if TYPE_CHECKING:
    Damage = dict[str, dict[str, Any]]
else:
    Damage = dict[str, dict[str, int | float | str | None]]
"""Drawn values of each kind of fault that a specimen has, beside its spalls, in SI units; ``site`` is the damaged part, if the kind does
not name it."""


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

    def at_severity(self, share: float) -> "Spall":
        """The same spall with a share of its width and depth; the roughness of its floor stays."""
        trace = tuple(share * depth for depth in self.trace)
        return replace(self, width=share * self.width, depth=share * self.depth, trace=trace)


class BearingFault(Section):
    """A fault of one part of a bearing."""

    labels: ClassVar[tuple[Variable, ...]] = ()
    """Variables of the corpus with the names of drawn values, 0 without the fault. A share of the severity of a fault is a share of these
    values, and of width and depth of its spalls."""

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

    def draw_spalls(self, draws: Draws, bearing: Bearing, known: Known) -> list[Spall]:  # noqa: ARG002 - of some kinds
        """Spalls of the part; ``known`` are quantities of rig, specimen and part."""
        return []

    def draw(self, draws: Draws, known: Known) -> Drawn:
        """All other values."""
        return draws.section(self, known)


class Healthy(BearingFault):
    """A bearing without a fault."""

    kind: Literal["healthy"]
    """Leaves the bearing undamaged."""

    @property
    def components(self) -> tuple[BearingFault, ...]:
        """None."""
        return ()


def draw_damage(
    faults: Iterable[BearingFault], draws: Draws, bearing: Bearing, known: Known
) -> tuple[tuple[Spall, ...], Damage]:
    """Spalls and further damage of a specimen; ``known`` are quantities of rig and specimen."""
    spalls, damage = list[Spall](), Damage()
    for fault in faults:
        race = {BALL_SPACING: ball_spacing(bearing, fault.part)} if fault.part in RACES else {}
        spalls += fault.draw_spalls(draws, bearing, {**known, **race})
        damage[fault.kind] = fault.draw(draws, {**known, **race})
    return tuple(spalls), {kind: drawn for kind, drawn in damage.items() if drawn}
