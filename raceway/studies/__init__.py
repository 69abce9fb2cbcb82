"""Studies that need both ``gen`` and ``features``.

=========== ===================================================================
module      responsibility
=========== ===================================================================
paper       the seed paper: its systems run, its figures 3 to 6 drawn
schematics  figures 1 and 2 of the seed paper: the model, the cracked bearing
measures    measures on displacements and spectra
experiments the one constant with which a statement of the paper holds
statements  the statements of the seed paper, measured
gallery     a page of pictures: the seed paper, every fault, run-ups
timing      speed of this machine, stage by stage
=========== ===================================================================
"""
