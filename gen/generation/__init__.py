"""From a recipe to a corpus: drawn, simulated, measured, labelled and written part by part, or kept in memory.

=========== ==================================================================
module      responsibility
=========== ==================================================================
sources     hash of the source files that make records
labels      variables written beside each record
undetected  records drawn, simulated and measured; faults that cannot be seen drawn again
step_checks some records integrated again at half their step
scheduling  records of several parts made together, so that batches are full
forecast    time that a corpus takes, from its steps and the rate of this machine
parts       parts labelled and written
compilation kernels of a recipe compiled before its first record
corpus      a corpus, part by part, with dask
replaying   any record made again from the scenario that it stores, bit for bit
memory      records as one Dataset, from keys or from scenarios made by hand
stream      records without end, straight into training
torch_items the same for the data loader of PyTorch
plan        counts, size and steps of a corpus before it is made
writing     a Dataset of records as a corpus
=========== ==================================================================
"""
