"""The command line of Raceway; ``raceway --help`` tells what it does.

========= =====================================================================
module    responsibility
========= =====================================================================
signals   Ctrl-C and SIGTERM, without noise from the workers
ending    exit codes, one sentence for what went wrong
show      results on standard output, as text or as one JSON object
options   arguments and options that several commands share
progress  how far a long command has come, on standard error
summary   what is in a corpus
bench     how fast this machine is, stage by stage
corpora   commands that make corpora and look at them
importing commands that bring real recordings into the format
learning  commands from a corpus to features, models and a report
reproduce the seed paper run again
gallery   a page of pictures of what the model makes
cli       the group of all commands, and the entry point
========= =====================================================================

Commands are thin: they read options, call ``gen`` and ``features``, and show what these return. Heavy libraries are imported inside the
commands, so that help and version answer at once.
"""
