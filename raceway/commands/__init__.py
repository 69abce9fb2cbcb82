"""The commands: each reads its options, calls ``gen``, ``features`` or a study, and shows the result.

================== ======================================================
module             responsibility
================== ======================================================
corpus_commands    commands that make corpora and look at them
plot_commands      a picture of one record or recording
feature_commands   features of all records
model_commands     a model trained, and scored on another corpus
benchmark_commands scores of all baselines
doctor_command     installed versions, and the speed of this machine
================== ======================================================

Heavy libraries are imported inside the commands, so that help and version are printed at once. A command that takes a recipe looks for
its file before it imports the simulator, so that a misspelt name is reported at once.
"""
