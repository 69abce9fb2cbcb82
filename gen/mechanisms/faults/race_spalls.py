"""Spalls on a race, and the keys that all spalls have."""

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from gen.drawing import Distribution, Draws, Number, Section, within
from gen.mechanisms.faults.bearing_fault import BALL_SPACING, RACES, BearingFault
from gen.physics.bearing import Bearing, ball_spacing
from gen.physics.kernel_input import Spall
from gen.support.errors import RecipeError
from gen.support.rounding import rounded_down
from gen.support.units import from_si, to_si

MAX_SPALLS = 16
Trace = Annotated[tuple[Annotated[Number, Field(ge=0, le=5000)], ...], Field(min_length=3, max_length=2000)]
_WIDEST = {"inner": 5.0, "outer": 5.0, "ball": 1.4}  # largest width of a spall over the radius of its surface


class JaggedEdge(Section):
    """A jagged edge, of which successive balls meet different points."""

    scatter_percent: Distribution = within(0, 100, default=20.0)
    """Scatter of the drop of a ball, and of its impact, from passage to passage: standard deviation of a log-normal factor."""


class Spalls(BearingFault):
    """Spalls of one part."""

    counted, sizes = "n_spalls", ("width_mm", "depth_um", "trace_um")
    lines: ClassVar = {
        "inner": ("bpfi", 1),
        "outer": ("bpfo", 1),
        "ball": ("bsf", 2),
    }  # a ball strikes both races in each spin

    n_spalls: Distribution = within(1, MAX_SPALLS, default=1)
    """Number of spalls, each with its own draws; rounded to a whole number."""
    width_mm: Distribution = within(0.001, 60, each=True)
    """Width of a spall along the rolling direction; it sets how far the ball drops, and how hard it hits the trailing edge."""
    depth_um: Distribution = within(0, 5000, open_low=True, each=True, default=280.0)
    """Depth of the floor of a spall. A ball that bridges a narrow spall does not reach the floor."""
    angle_deg: Distribution = within(-360, 360, each=True, default=0.0)
    """Position of a spall: on the outer race from the direction of the load, on the inner race and on a ball from a mark that turns."""
    profile: Literal["geometric", "half_sine", "raised_cosine", "rectangular", "trace"] = "geometric"
    """Path of a ball through the spall: a rigid ball over two edges and a floor, a formula, or a measured trace."""
    trace_um: Trace | None = None
    """Measured depths of the surface from edge to edge, evenly spaced; for `profile: trace`, which scales them to `width_mm`."""
    roughness_um: Distribution = within(0, 50, each=True, default=0.0)
    """Rms roughness of the floor of a geometric or traced spall."""
    jagged_edge: JaggedEdge | None = None
    """Edge that each ball meets a little differently; the same for all balls if left out."""

    @model_validator(mode="after")
    def _traced(self) -> Self:
        if (self.profile == "trace") != (self.trace_um is not None):
            raise ValueError("profile: trace and trace_um belong together; give both or neither.")
        if self.profile not in ("geometric", "trace") and self.roughness_um.support()[1] > 0:
            raise ValueError(f"roughness_um: only a geometric or traced spall has a floor, not {self.profile}.")
        return self

    @property
    def n_numbers(self) -> int:
        """Of the traces of its spalls."""
        return round(self.n_spalls.support()[1]) * len(self.trace_um or ())

    def draw(self, of: Draws) -> Any:
        """Spalls of one part of a bearing, whose widths can be shares of the distance between balls."""
        if self.part in RACES:
            of = of._replace(wholes={**of.wholes, BALL_SPACING: ball_spacing(of.bearing, self.part)})
        return super().draw(of)

    def check(self, bearing: Bearing, item: str) -> None:
        """RecipeError if a spall is too wide for its race or ball."""
        radius, widest = bearing.radius(self.part), widest_spall(self.part, bearing)
        for width in self.si()["width"]:
            if width > widest:
                raise RecipeError(
                    f"{item}: a spall of {from_si(width, 'mm'):g} mm does not fit the {self.part} radius of "
                    f"{from_si(radius, 'mm'):.3g} mm; keep width_mm below {rounded_down(from_si(widest, 'mm'))}."
                )

    def spalls(self, load_angle: float) -> list[Spall]:
        """Spalls of the part, those of the outer race with their angles from the x axis."""
        drawn = self.si()
        trace = tuple(to_si(depth, "um") for depth in self.trace_um or ())
        scatter = 0.0 if self.jagged_edge is None else self.jagged_edge.si()["scatter"]
        first = load_angle if self.part == "outer" else 0.0
        sizes = zip(*(drawn[name].tolist() for name in ("width", "depth", "angle", "roughness")), strict=True)
        return [
            Spall(
                self.part, width, max(trace, default=depth), first + angle, getattr(self, "ball", 0) or 0, self.profile,
                scatter=scatter, roughness=roughness, trace=trace,
            )
            for width, depth, angle, roughness in sizes
        ]  # fmt: skip


class RaceFault(Spalls):
    """Spalls on one race: lines at BPFI (inner) or BPFO (outer)."""

    kind: Literal["inner", "outer"]
    """Puts the spalls on the inner or on the outer race."""


def widest_spall(site: str, bearing: Bearing) -> float:
    """Largest width of a spall of a race or ball [m]."""
    return _WIDEST[site] * bearing.radius(site)
