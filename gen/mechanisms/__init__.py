"""What happens in a machine and its measuring chain, one mechanism a file: the keys of a recipe, the draw, the effect and the labels.

=============== =====================================================================
module          responsibility
=============== =====================================================================
filtering       filters that several mechanisms use
rattle          motion of a sensor that lifts off and strikes the machine
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

A further fault of the measuring chain is one file, and its line in ``measuring_chain.CHAIN``.
"""
