"""The command line of Raceway; ``raceway --help`` lists the commands.

======== =====================================================================
module   responsibility
======== =====================================================================
console  options, results, progress, errors
studies  the seed paper, the gallery and the speed of this machine
commands one function per command
cli      the group of all commands, and the entry point
======== =====================================================================
"""
