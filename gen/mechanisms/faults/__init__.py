"""Faults of a bearing, one kind a file: the keys of a recipe, the draw, the damaged part, the severity and the labels.

============= ===============================================================
module        responsibility
============= ===============================================================
bearing_fault what a fault of a bearing is, and the damage that it draws
race_spalls   spalls on a race, and the keys of all spalls
ball_spalls   spalls on a ball
broken_cage   a broken cage
worn_race     a race worn over its whole circumference
compound      faults of several components
============= ===============================================================

A further kind is one file, its row here and its place in ``KINDS``; a class of its own is one more row of ``gen.corpus.fault_classes``.
"""

from gen.mechanisms.faults.ball_spalls import BallFault
from gen.mechanisms.faults.bearing_fault import BearingFault, Healthy
from gen.mechanisms.faults.broken_cage import CageFault
from gen.mechanisms.faults.compound import CompoundFault
from gen.mechanisms.faults.race_spalls import RaceFault
from gen.mechanisms.faults.worn_race import DistributedFault

KINDS: tuple[type[BearingFault], ...] = (Healthy, RaceFault, BallFault, CageFault, DistributedFault, CompoundFault)
"""In the order in which a recipe lists their keys."""
