"""Faults of several components."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from gen.mechanisms.faults.ball_spalls import BallFault
from gen.mechanisms.faults.bearing_fault import BearingFault
from gen.mechanisms.faults.broken_cage import CageFault
from gen.mechanisms.faults.race_spalls import RaceFault


class CompoundFault(BearingFault):
    """Faults of several components at once, labelled `compound`."""

    kind: Literal["compound"]
    """Combines faults of different components in one bearing."""
    parts: Annotated[
        tuple[Annotated[RaceFault | BallFault | CageFault, Field(discriminator="kind")], ...],
        Field(min_length=2, max_length=4),
    ]
    """Faults of the components, all of different kinds, with the keys of `faults` but no weights."""

    @model_validator(mode="after")
    def _of_several_parts(self) -> Self:
        kinds = [part.kind for part in self.parts]
        if len(set(kinds)) < len(kinds):
            raise ValueError(
                f"parts: {', '.join(kinds)} are not all different; several spalls of one part need no compound."
            )
        return self

    def at_severity(self, share: float) -> Self:
        """The same with a share of the sizes of each part."""
        return self.model_copy(update={"parts": tuple(part.at_severity(share) for part in self.parts)})

    @property
    def components(self) -> tuple[BearingFault, ...]:
        """Its parts."""
        return self.parts
