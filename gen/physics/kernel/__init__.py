"""The compiled kernel: a batch of records, one per lane, from its first knot to its last.

============ ===================================================================
module       responsibility
============ ===================================================================
compiling    how the kernel is compiled: one record per lane, fixed rounding
drop         how far a ball drops over a spall
equations    the equations of motion
step         the Runge-Kutta step
turning      shaft, cage and balls from knot to knot, and the outer forces
spalls       the gap under every ball: waviness and spalls
decimate     from the rate of the steps down to the sample rate
batch        records laid out in lanes
integrate    a batch from start to end, decimated on the way
============ ===================================================================
"""
