"""All kinds of faults of a bearing."""

from gen.mechanisms.faults.ball_spalls import BallFault
from gen.mechanisms.faults.bearing_fault import BearingFault, Healthy
from gen.mechanisms.faults.broken_cage import CageFault
from gen.mechanisms.faults.compound import CompoundFault
from gen.mechanisms.faults.race_spalls import RaceFault
from gen.mechanisms.faults.worn_race import DistributedFault
from gen.mechanisms.mechanism import with_plugins

KINDS: tuple[type[BearingFault], ...] = with_plugins(
    BearingFault, (Healthy, RaceFault, BallFault, CageFault, DistributedFault, CompoundFault)
)
"""In the order in which a recipe lists their keys."""
