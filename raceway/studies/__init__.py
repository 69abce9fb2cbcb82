"""Studies that need both ``gen`` and ``features``.

============= ====================================================================
module        responsibility
============= ====================================================================
paper         the seed paper: its systems run, its figures drawn
statements    the statements of the seed paper, measured
sensor_faults pictures of every sensor fault and of a gear mesh
gallery       a page of pictures: the seed paper, every fault, run-ups, sensor faults
timing        speed of this machine, stage by stage
============= ====================================================================
"""
