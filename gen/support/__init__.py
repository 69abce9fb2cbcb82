"""What all stages use: errors, limits, units, YAML, progress, and the executor that runs independent work.

============== =============================================================================
module         responsibility
============== =============================================================================
errors         one exception class per stage; each carries one sentence
garbage        cheaper making of many objects
sources        hash of source files
plugins        what other distributions add by entry points
kernel_cache   compiled kernels on disk, made again if they are damaged or of other sources
progress       progress of a long call
display        what an object shows in print and in a notebook
limits         how much a file from elsewhere may ask for
units          units of recipes and labels, turned into SI
rounding       limits in sentences, rounded to the side that is allowed
yaml_files     recipes and common keys of labels, read within the limits
key_types      types of keys that people write about their recordings
sentences      an error sentence for each wrong key or value of these files
executor       a function of many items: in this process, or by dask
cluster        clients of dask: of processes of this machine, or of a scheduler
copied_workers dask workers of this machine, copies of one process that loaded the libraries
============== =============================================================================
"""
