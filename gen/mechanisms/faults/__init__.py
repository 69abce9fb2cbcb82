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
kinds         all of them, those of plug-ins included
============= ===============================================================

A further kind is one file, its row here and its place in ``kinds.KINDS``.
"""
