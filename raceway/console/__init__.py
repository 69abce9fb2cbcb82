"""What every command shares: options in; results, progress and errors out.

======== ====================================================================
module   responsibility
======== ====================================================================
signals  Ctrl-C and SIGTERM, without noise from the workers
ending   exit codes, one sentence for what went wrong
show     results on standard output, as text or as one JSON object
options  arguments and options that several commands share
progress how far a long command has come, on standard error
summary  what is in a corpus
======== ====================================================================
"""
