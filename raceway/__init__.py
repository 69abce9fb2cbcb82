"""The command line of Raceway, of which ``raceway --help`` lists the commands, and their calls from Python.

``raceway.diagnose``, ``limit``, ``imitate``, ``publish`` and others are listed below; ``raceway.show_progress()`` shows the progress of a
call.

============= ========================================================================
module        responsibility
============= ========================================================================
console       options, results, progress, errors
kept_models   the reference model, trained once and kept per user
importing     a job: recordings of people in the format of corpora
imitating     a job: a recipe of a machine from a healthy recording of it
comparing     a job: synthetic records against real ones
lives         a job: remaining life of bearings run to failure
visibility    a job: the smallest fault that can be seen
diagnosis     a job: what is wrong with a recording
sharing       a job: corpora copied, described and published
reports       a job: pages and pictures of corpora and scores
commands      one function per command
cli           the group of all commands, and the entry point
============= ========================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
