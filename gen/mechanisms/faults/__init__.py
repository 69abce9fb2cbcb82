"""Faults of a bearing, one kind a file: the keys of a recipe, the draw, the effect and the labels.

============= ===============================================================
module        responsibility
============= ===============================================================
bearing_fault what a fault of a bearing is, and the damage that it draws
race_spalls   spalls on a race, and the keys of all spalls
ball_spalls   spalls on a ball
broken_cage   a broken cage
worn_race     a race worn over its whole circumference
kinds         all kinds, and the compound of several
============= ===============================================================

A further kind is one file, and its place in ``kinds.KINDS``; a class of its own is one more row of ``gen.corpus.fault_classes``.
"""
