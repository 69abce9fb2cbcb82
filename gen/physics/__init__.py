"""The model: floats and arrays in and out, no files, no units but SI.

========== ================================================================
module     responsibility
========== ================================================================
extent     how many balls, orders and points the model holds
bearing    geometry, fault frequencies in orders of the shaft
elementary powers and logarithms with the same bits everywhere
catalogue  bearings by designation, with ratings and sources
hertz      point and line contact: geometry to load-deflection factor
rotor      machine constants, static rest, fastest swing
rating     static load rating and equivalent static load
lubricant  oil film and temperature: clearance, stiffness, damping
axial      how much clearance an axial load takes up
profile    how speed and load change over a record
trace      path of a ball over a measured surface, and its mean over a contact
inputs     the nouns that the kernel takes
kernel     compiled: records in lanes, integrated and decimated
========== ================================================================
"""
