"""The physical model: functions of floats and arrays in SI units, without files.

============ =====================================================================
module       responsibility
============ =====================================================================
extent       largest numbers of balls, waviness orders and table points
bearing      geometry, fault frequencies in orders of the shaft
elementary   powers and logarithms with the same bits on every processor
catalogue    bearings by designation, with ratings and sources
bearing_text a bearing given as a text or by its dimensions
hertz        load-deflection factor of point and line contacts
rotor        machine constants, static equilibrium, bounds of its eigenfrequencies
rating       static load rating and equivalent static load
resonance    resonances that are excited at their base
orbit        elliptical motion at one frequency
rattle       bodies that lift off what holds them, and strike it; compiled
lubricant    oil film and temperature: clearance, stiffness, damping
axial        squeeze of the balls by an axial load
profile      change of speed and load over a record
trace        path of a ball over a measured surface, and its mean over a contact
kernel_input input of the kernel for one record
kernel       compiled: integrates and decimates many records at once
============ =====================================================================
"""
