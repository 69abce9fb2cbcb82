"""Options, results, progress and errors: the parts that all commands share.

=============== =========================================================
module          responsibility
=============== =========================================================
interruption    Ctrl-C and SIGTERM end a command with one line
ending          exit codes, and one sentence per error
show            results on standard output, as text or as JSON
corpus_table    the feature table of a corpus that a command names
options         arguments and options that several commands share
progress_bar    progress of a long command, on standard error
corpus_counts   counts of a corpus for people
summary         contents of a corpus, for ``raceway info``
plugin_commands groups of commands to which plug-ins add theirs
=============== =========================================================
"""
