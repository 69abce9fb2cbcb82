"""Faults of a bearing: spalls of one component or of several, worn races, a broken cage."""

from typing import Annotated, Literal, Self

from pydantic import Field, StrictInt, model_validator

from gen.drawing import Distribution, Number, Section, Weight, within
from gen.physics.extent import HIGHEST_ORDER, LOWEST_ORDER
from gen.recipe.changes import LevelChanges, OperationChanges

MAX_SPALLS = 16
Trace = Annotated[tuple[Annotated[Number, Field(ge=0, le=5000)], ...], Field(min_length=3, max_length=2000)]


class _Weighted(Section):
    weight: Weight = 1.0
    """Share of the records with this fault, relative to the other entries of `faults`, whatever `corpus.specimens_per_rig` is."""
    operation: OperationChanges | None = None
    """Keys of `operation` that replace those of the recipe for this entry. Beware: speed or load alone may then tell its class."""
    level: LevelChanges | None = None
    """Keys of `level` that replace those of the recipe for this entry, with `level.kind: snr`. Beware: they too may tell its class."""


class Healthy(_Weighted):
    """A bearing without a fault."""

    kind: Literal["healthy"]
    """Leaves the bearing undamaged."""


class JaggedEdge(Section):
    """A jagged edge, of which successive balls meet different points."""

    scatter_percent: Distribution = within(0, 100, default=20.0)
    """Scatter of the drop of a ball, and of its impact, from passage to passage: standard deviation of a log-normal factor."""


class AxisJumps(Section):
    """Jumps of the spin axis of a damaged ball, at most one per turn of the cage, where the ball is opposite the load."""

    probability_percent: Distribution = within(0, 100, default=50.0)
    """Probability of a jump in a turn of the cage."""
    spread_deg: Distribution = within(0, 90, default=10.0)
    """Standard deviation of the tilt after a jump, in addition to `axis_offset_deg`, and of the change of the spin angle."""


class _Spalled(_Weighted):
    n_spalls: Distribution = within(1, MAX_SPALLS, default=1)
    """Number of spalls, each with its own draws; rounded to a whole number."""
    width_mm: Distribution = within(0, 60, open_low=True)
    """Width of a spall along the rolling direction; it sets how far the ball drops, and how hard it hits the trailing edge."""
    depth_um: Distribution = within(0, 5000, open_low=True, default=280.0)
    """Depth of the floor of a spall. A ball that bridges a narrow spall does not reach the floor."""
    angle_deg: Distribution = within(-360, 360, default=0.0)
    """Position of a spall: on the outer race from the direction of the load, on the inner race and on a ball from a mark that turns."""
    profile: Literal["geometric", "half_sine", "raised_cosine", "rectangular", "trace"] = "geometric"
    """Path of a ball through the spall: a rigid ball over two edges and a floor, a formula, or a measured trace."""
    trace_um: Trace | None = None
    """Measured depths of the surface from edge to edge, evenly spaced; for `profile: trace`, which scales them to `width_mm`."""
    roughness_um: Distribution = within(0, 50, default=0.0)
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


class RaceFault(_Spalled):
    """Spalls on one race: lines at BPFI (inner) or BPFO (outer)."""

    kind: Literal["inner", "outer"]
    """Puts the spalls on the inner or on the outer race."""


class BallFault(_Spalled):
    """Spalls on one ball, which hit both races: a line at twice BSF."""

    kind: Literal["ball"]
    """Puts the spalls on one ball."""
    track_deg: Distribution = within(0, 90, default=8.6)
    """Tilt of the spin axis at which a spall leaves the ball's track and is not hit; at 0 it is hit at every turn."""
    axis_offset_deg: Distribution = within(-90, 90, default=0.0)
    """Mean tilt of the spin axis of the ball."""
    axis_wander_deg: Distribution = within(0, 180, default=0.0)
    """Rms of the random variation of that tilt (0.05 to 0.6 shaft rates); it makes hits rarer and irregular."""
    axis_jumps: AxisJumps | None = None
    """Jumps of the spin axis from one turn of the cage to the next; none if left out."""


class CageFault(_Weighted):
    """A broken cage: one ball is out of place, and its pocket knocks on the housing once per cage turn."""

    kind: Literal["cage"]
    """Breaks one pocket of the cage: lines at FTF and its multiples."""
    pitch_error_deg: Distribution = within(0, 10, default=3.0)
    """Angle around the bearing by which the ball of the broken pocket is displaced."""
    knock_n: Distribution = within(0, 10_000, default=20.0)
    """Typical peak force of the knock, 60 degrees after the pocket has passed the direction of the load; 0 for none."""


class DistributedFault(_Weighted):
    """A race worn over its whole circumference; records are labelled with the race."""

    kind: Literal["distributed"]
    """Adds waviness to a whole race: noise at low frequency, no line in the envelope spectrum."""
    site: Literal["inner", "outer"]
    """Race that is worn, and the class label."""
    waviness_um: Distribution = within(0, 50, open_low=True, default=0.5)
    """Rms waviness of the worn race, in addition to that of the specimen."""
    order: Annotated[StrictInt, Field(ge=LOWEST_ORDER, le=HIGHEST_ORDER)] | None = None
    """Waves per turn, if all wear has one order; if left out, orders 2 to 60 with amplitudes that fall as 1/order."""


DamagedPart = Annotated[RaceFault | BallFault | CageFault, Field(discriminator="kind")]


class CompoundFault(_Weighted):
    """Faults of several components at once, labelled `compound`."""

    kind: Literal["compound"]
    """Combines faults of different components in one bearing."""
    parts: Annotated[tuple[DamagedPart, ...], Field(min_length=2, max_length=4)]
    """Faults of the components, all of different kinds, with the keys of `faults` but no weights."""

    @model_validator(mode="after")
    def _of_several_parts(self) -> Self:
        kinds = [part.kind for part in self.parts]
        if len(set(kinds)) < len(kinds):
            raise ValueError(
                f"parts: {', '.join(kinds)} are not all different; several spalls of one part need no compound."
            )
        for key in _Weighted.model_fields:
            parts = [part.kind for part in self.parts if key in part.model_fields_set]
            if parts:
                named = f"{'an' if key[0] in 'aeiou' else 'a'} {key} of {', '.join(parts)}"
                raise ValueError(f"parts: {named} alone does nothing; give the compound one.")
        return self


Fault = Annotated[
    Healthy | RaceFault | BallFault | CageFault | DistributedFault | CompoundFault, Field(discriminator="kind")
]


def fault_class(fault: Fault) -> str:
    """Class label of records with a fault."""
    return fault.site if isinstance(fault, DistributedFault) else fault.kind
