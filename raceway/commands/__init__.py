"""The commands: each reads its options, calls ``gen``, ``features`` or a study, and shows the result.

============== ======================================================
module         responsibility
============== ======================================================
corpora        commands that make corpora and look at them
plotting       a picture of one record or recording
feature_tables features of all records
models         a model trained, and scored on another corpus
references     healthy records that the tested ones are compared with
benchmarking   scores of all baselines
doctor         installed versions, and the speed of this machine
============== ======================================================

Heavy libraries are imported inside the commands, so that help and version are printed at once. A command that takes a recipe looks for
its file before it imports the simulator, so that a misspelt name is reported at once.
"""
