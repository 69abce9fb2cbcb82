"""Accelerations of the bodies in, records as a data-acquisition card stores them out.

============ ===============================================================================================
module       responsibility
============ ===============================================================================================
measure      the steps: signal, path, background, level, chain, converter, and whether the fault can be seen
rig          transfer paths and machine background of a rig
mixing       modulation by the shaft and lines of the machine, compiled
components   bearing of a record behind its transfer paths; noise, lines and impulses of its machine
gains        gains of bearing and background
judging      whether the fault of a record can be seen in it
ends_of_life ends of lives that are seen in the records
============ ===============================================================================================
"""
