"""What is wrong with a bearing: spalls of one part or several, worn races, a broken cage."""

from typing import Annotated, Literal, Self

from pydantic import Field, StrictInt, model_validator

from gen.physics.extent import HIGHEST_ORDER, LOWEST_ORDER
from gen.recipe.distributions import Distribution, Number, within
from gen.recipe.section import Section, Weight

MAX_SPALLS = 16
Trace = Annotated[tuple[Annotated[Number, Field(ge=0, le=5000)], ...], Field(min_length=3, max_length=2000)]


class Healthy(Section):
    """A bearing without a fault."""

    kind: Literal["healthy"]
    weight: Weight = 1.0


class _Spalls(Section):
    weight: Weight = 1.0
    spalls: Distribution = within(1, MAX_SPALLS, default=1)
    width_mm: Distribution = within(0, 60, open_low=True)
    depth_um: Distribution = within(0, 5000, open_low=True, default=280.0)
    angle_deg: Distribution = within(-360, 360, default=0.0)
    profile: Literal["geometric", "half_sine", "raised_cosine", "rectangular", "trace"] = "geometric"
    trace_um: Trace | None = None
    """Depth of the surface from edge to edge as a stylus measures it, evenly spaced, for ``profile: trace``."""
    roughness_um: Distribution = within(0, 50, default=0.0)
    """Rms of the floor of a geometric or traced spall."""

    @model_validator(mode="after")
    def _traced(self) -> Self:
        if (self.profile == "trace") != (self.trace_um is not None):
            raise ValueError("profile: trace and trace_um belong together; give both or neither.")
        if self.profile not in ("geometric", "trace") and self.roughness_um.support()[1] > 0:
            raise ValueError(f"roughness_um: only a geometric or traced spall has a floor, not {self.profile}.")
        return self


class RaceFault(_Spalls):
    """Spalls on a race; the angle of an outer race spall counts from the load direction."""

    kind: Literal["inner", "outer"]


class BallFault(_Spalls):
    """Spalls on a ball, whose spin axis wanders about an offset; beyond ``track_deg`` the spall misses the track."""

    kind: Literal["ball"]
    track_deg: Distribution = within(0, 90, default=8.6)
    axis_offset_deg: Distribution = within(-90, 90, default=0.0)
    axis_wander_deg: Distribution = within(0, 180, default=0.0)


class CageFault(Section):
    """A broken cage: one ball out of its place, and a knock on the housing once per turn as that ball leaves the load zone."""

    kind: Literal["cage"]
    weight: Weight = 1.0
    pitch_error_deg: Distribution = within(0, 10, default=3.0)
    knock_n: Distribution = within(0, 10_000, default=20.0)


class DistributedFault(Section):
    """A race worn all round: waviness, of one ``order`` per turn or falling as 1/order; its class is that of its ``site``."""

    kind: Literal["distributed"]
    weight: Weight = 1.0
    site: Literal["inner", "outer"]
    waviness_um: Distribution = within(0, 50, open_low=True, default=0.5)
    order: Annotated[StrictInt, Field(ge=LOWEST_ORDER, le=HIGHEST_ORDER)] | None = None


Part = Annotated[RaceFault | BallFault | CageFault, Field(discriminator="kind")]


class CompoundFault(Section):
    """Faults of several parts at once, with one weight together."""

    kind: Literal["compound"]
    weight: Weight = 1.0
    parts: Annotated[tuple[Part, ...], Field(min_length=2, max_length=4)]

    @model_validator(mode="after")
    def _of_several_parts(self) -> Self:
        kinds = [part.kind for part in self.parts]
        if len(set(kinds)) < len(kinds):
            raise ValueError(
                f"parts: {', '.join(kinds)} are not all different; several spalls of one part need no compound."
            )
        weighted = [part.kind for part in self.parts if "weight" in part.model_fields_set]
        if weighted:
            raise ValueError(f"parts: a weight of {', '.join(weighted)} alone does nothing; give the compound one.")
        return self


Fault = Annotated[
    Healthy | RaceFault | BallFault | CageFault | DistributedFault | CompoundFault, Field(discriminator="kind")
]


def fault_class(fault: Fault) -> str:
    """Class that records of a fault are labelled with."""
    return fault.site if isinstance(fault, DistributedFault) else fault.kind
