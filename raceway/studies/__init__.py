"""Studies that need both ``gen`` and ``features``.

========== ====================================================================
module     responsibility
========== ====================================================================
paper      the seed paper: its systems run, its figures drawn
statements the statements of the seed paper, measured
gallery    a page of pictures: the seed paper, every fault, run-ups
timing     speed of this machine, stage by stage
========== ====================================================================
"""
