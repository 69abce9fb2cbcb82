"""The model: floats and arrays in and out, no files, no units but SI.

========== ================================================================
module     responsibility
========== ================================================================
bearing    geometry, fault frequencies in orders of the shaft
elementary powers and logarithms with the same bits everywhere
catalogue  bearings by designation, with ratings and sources
hertz      point and line contact: geometry to load-deflection factor
rating     static load rating and equivalent static load
lubricant  oil film and temperature: clearance, stiffness, damping
profile    how speed and load run over a record
lanes      how kernels are compiled: one record per lane
spall      how far a ball drops as it rolls over a defect
rotor      machine constants, static rest, fastest swing
axial      what an axial load takes up of the clearance
kernel     equations of motion
step       the Runge-Kutta step
gaps       the gap under every ball: waviness and spalls
motion     how shaft, cage, balls and spalls move between two steps' knots
trace      path of a ball over a measured surface, and what is felt of it
decimate   from the rate of the steps down to the sample rate
integrate  a batch from start to end, decimated on the way
batch      records laid out in lanes
========== ================================================================
"""
