"""The model: floats and arrays in and out, no files, no units but SI.

========= ================================================================
module    responsibility
========= ================================================================
bearing   geometry, fault frequencies in orders of the shaft
catalogue bearings by designation, with ratings and sources
hertz     point and line contact: geometry to load-deflection factor
lanes     how kernels are compiled: one record per lane
spall     how far a ball drops as it rolls over a defect
rotor     machine constants, static rest, fastest swing
kernel    equations of motion and the Runge-Kutta step
gaps      the gap under every ball: waviness and spalls
motion    how shaft, cage, balls and spalls move between two steps' knots
integrate a batch from start to end, decimated on the way
batch     records laid out in lanes
========= ================================================================
"""
