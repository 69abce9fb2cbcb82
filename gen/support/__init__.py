"""What all stages use: errors, limits, units, YAML, progress, and independent tasks on the cores of this machine or on a cluster.

========== ==================================================================
module     responsibility
========== ==================================================================
errors     one exception class per stage; each carries one sentence
garbage    cheaper making of many objects
sources    hash of source files
kernels    compiled kernels on disk, made again if they are damaged or of other sources
progress   progress of a long call
shown      what an object shows in print and in a notebook
limits     how much a file from elsewhere may ask for
units      units of recipes and labels, turned into SI
yaml_files recipes and common keys of labels, read within the limits
sentences  an error sentence for each wrong key or value of these files
cluster    independent tasks on dask
workers    independent tasks in this thread, threads, processes or a cluster
processes  a task without end, shared out to processes of this machine
========== ==================================================================
"""
