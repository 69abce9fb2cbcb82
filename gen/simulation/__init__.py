"""Scenarios in, accelerations at the bodies out.

======== ==============================================================
module   responsibility
======== ==============================================================
damage   spalls and waviness, as the kernel takes them
machine  constants of the machine, its motion, speed and load over time
simulate a batch of scenarios integrated; the step and its check
outline  kernel shape and steps of a record, without building it
======== ==============================================================
"""
