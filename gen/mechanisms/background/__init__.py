"""Background of a machine: its noise, and sources of vibration beside its bearings.

================== =============================================================
module             responsibility
================== =============================================================
source             what a source is
noise              colour, resonances and coherence of the noise
spectral_lines     lines at multiples of the shaft rate and at fixed frequencies
impulses           impulses at random times and locked to the shaft
gear_mesh          multiples of a tooth mesh with sidebands of both gears
machine_condition  lines and bursts of a machine that is not well
machine_conditions conditions of a rig, and their label
looseness          machines whose support lifts off the ground
background         all of them, as a recipe has them and as they are drawn
================== =============================================================

A further source is one file, and its line in ``background.MACHINE_SOURCES``.
"""
