"""Scenarios in, accelerations of the bodies out.

=============== ====================================================================
module          responsibility
=============== ====================================================================
timeline        the time axis: settling, lead, record
surroundings    constants of the machine: oil, temperature and axial load included
motion          how shaft, cage and balls turn; speed and load over time
shaft           angle of the shaft at every sample
damage          spalls and waviness
inputs          kernel inputs, put together from these
hits            how often loaded balls pass the spalls
compiled_kernel the kernel of this machine
batches         records grouped by shape and step, and integrated in lanes
steps           the step: chosen before the run, checked after it
simulate        scenarios integrated
truth           variables of a corpus that are known of a record by construction
=============== ====================================================================
"""
