"""The model: floats and arrays in and out, no files, no units but SI.

========== ================================================================
module     responsibility
========== ================================================================
extent     sizes of the model, without loading the kernel
bearing    geometry, fault frequencies in orders of the shaft
elementary powers and logarithms with the same bits everywhere
catalogue  bearings by designation, with ratings and sources
hertz      point and line contact: geometry to load-deflection factor
rating     static load rating and equivalent static load
lubricant  oil film and temperature: clearance, stiffness, damping
profile    how speed and load run over a record
rotor      machine constants, static rest, fastest swing
axial      what an axial load takes up of the clearance
kernel     compiled: records in lanes, integrated and decimated
trace      path of a ball over a measured surface, and what is felt of it
========== ================================================================
"""
