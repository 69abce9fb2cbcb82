"""Background of a machine: its noise, and sources of vibration beside its bearings.

=================== =============================================================
module              responsibility
=================== =============================================================
source              what a source is, and a condition of a machine
noise               colour, resonances and coherence of the noise
recorded_background a recording in place of the noise
tones               lines at fixed frequencies
impulses            impulses at random times and locked to the shaft
gear_mesh           multiples of a tooth mesh with sidebands of both gears
tooth_fault         a damaged tooth of one of the gears
bursts              noise that comes and goes with the shaft
shaft_lines         lines of the shaft, unbalance, bent shafts, misalignment, belts
rub                 rotors that touch their casing
looseness           machines whose support lifts off the ground
machine_conditions  all conditions, and their label
background          all of them, as a recipe has them and as they are drawn
=================== =============================================================

A further source is one file, and its line in ``background``; a further condition one file, and its line in ``machine_conditions``.
"""
