"""Faults of the measuring chain.

=============== =====================================================================
module          responsibility
=============== =====================================================================
filtering       filters that several faults use
sensor_fault    what a fault of the measuring chain is
loose_mount     sensors that are not held firmly
drift           baselines that move slowly
mains_hum       hum of the power supply
emi_bursts      oscillations that a switching contact induces
gain_steps      sudden changes of the sensitivity
saturation      amplifiers of a limited range
dropped_samples gaps in the data transfer
measuring_chain all faults of the measuring chain, in the order in which they act
=============== =====================================================================

A further fault is one file, and its line in ``measuring_chain.CHAIN``.
"""
