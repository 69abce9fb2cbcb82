"""Faults of the measuring chain.

=============== =====================================================================
module          responsibility
=============== =====================================================================
sensor_fault    what a fault of the measuring chain is, and a filter that several use
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
