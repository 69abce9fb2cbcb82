"""Studies that need both ``gen`` and ``features``.

====== ====================================================================
module responsibility
====== ====================================================================
paper  the seed paper, run and compared with its statements
timing how fast this machine is, stage by stage
====== ====================================================================
"""
