"""The compiled kernel: a batch of records, one per lane, from its first knot to its last.

============ ===================================================================
module       responsibility
============ ===================================================================
compiling    how the kernel is compiled: one record per lane, fixed rounding
layout       every array of the kernel, and every row in it, by name
drop         how far a ball drops over a spall
contacts     the force of the rolling elements
equations    the equations of motion
step         one step of the classical Runge-Kutta method
turning      how shaft, cage and balls turn from knot to knot
chance       random numbers that are functions of a count and a seed
pulse        half-sine pulses of force
outer_forces load, misalignment and cage knocks from knot to knot
waviness     the gap under every ball: clearance and waviness
spalls       the drop of every ball that passes a spall
decimate     from the rate of the steps down to the sample rate
batch        records laid out in lanes
integrate    a batch from its first knot to its last
============ ===================================================================

A function in this folder knows no file, no unit but SI, and no recipe; it works on all lanes of a batch at once.
"""
