"""Accelerations of the bodies in, records as a data-acquisition card stores them out.

================= ======================================================================
module            responsibility
================= ======================================================================
rig               transfer paths and machine background of a rig
mixing            bearing and background of a record put together, compiled
background        noise, lines and impulses of the machine in one record
levels            gains of bearing and background
judging           whether the fault of a record can be seen in it
measure           path, modulation, background, level and converter, record by record
lives             ends of lives that are seen in the records
================= ======================================================================
"""
