"""The command line of Raceway; ``raceway --help`` tells what it does.

======== =====================================================================
module   responsibility
======== =====================================================================
console  options, results, progress, errors
studies  the seed paper and the timing of this machine
commands one function for each command
cli      the group of all commands, and the entry point
======== =====================================================================
"""
