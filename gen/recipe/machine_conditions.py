"""Machines that are not well, while their bearings may be."""

from typing import Annotated, Literal

from pydantic import Field, StrictInt

from gen.drawing.distributions import Distribution, within
from gen.drawing.section import Probability, Section, Weight

MachineKind = Literal["unbalance", "bent_shaft", "misalignment", "looseness", "rub", "belt"]


class Bursts(Section):
    """Bursts of noise that come and go with the shaft, as parts that strike or rub make them."""

    level_db: Distribution = within(-80, 40)
    """Rms of the bursts relative to that of the background noise."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Number of bursts in a turn of the shaft."""
    length_deg: Distribution = within(1, 180, default=30.0)
    """Length of a burst, in degrees from burst to burst: a short one gives many harmonics."""


class MachineCondition(Section):
    """What one condition adds to the background: lines at multiples of an order of the shaft, and bursts of noise locked to it."""

    kind: MachineKind
    """Name of the condition in `machine_condition`, the label of the machine; the keys below say what it adds."""
    weight: Weight = 1.0
    """Share of the machines with this condition, relative to the other entries."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Order of the shaft whose multiples it shows: 1 for the shaft, 0.5 for looseness and rub, that of the belt for a belt."""
    count: Distribution = within(0, 400, default=0.0)
    """Number of lines, at 1, 2, ... times `order`, rounded to a whole number; those beyond half the sample rate are left out."""
    level_db: Distribution = within(-80, 40, default=-20.0)
    """Rms of a line relative to that of the background noise, drawn for each."""
    strongest: Annotated[StrictInt, Field(ge=1, le=400)] | None = None
    """Number of the line that gets the largest of the drawn levels: 1 for unbalance, 2 for misalignment; any if left out."""
    bursts: Bursts | None = None
    """Bursts of noise locked to the shaft; none if left out."""


class MachineConditionsSection(Section):
    """Conditions of the machine other than those of its bearings, drawn per rig and the same for all classes of bearings."""

    probability: Probability
    """Share of the rigs whose machine has one of the conditions."""
    entries: Annotated[tuple[MachineCondition, ...], Field(min_length=1)]
    """Conditions, one of which a machine has; drawn by weight."""
