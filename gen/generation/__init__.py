"""From a recipe to a corpus: parts are made one by one, and written, kept in memory or streamed into training.

``recipe, numbers -> make_part -> Dataset``; everything else decides which parts are made, where, and what becomes of them.

============== =============================================================================
module         responsibility
============== =============================================================================
identity       file name of a part; its recipe, sources and libraries
labels         variables written beside each record
undetected     records drawn, simulated and measured; faults that cannot be seen drawn again
step_checks    some records integrated again at half their step
make_part      a part: its records and labels, from the recipe and their numbers
compilation    the kernel compiled before the first record
target         the folder of a corpus, checked before anything is made
corpus         a corpus, part by part
replaying      any record made again from the scenario that it stores, bit for bit
memory         records as one Dataset, from keys or from scenarios made by hand
stream         records without end, straight into training
torch_items    the same for the data loader of PyTorch
trial          some records made, for time, size and visible faults of all
plan           counts, size and steps of a corpus before it is made
writing        a Dataset of records as a corpus
============== =============================================================================
"""
