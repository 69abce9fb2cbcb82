"""Accelerations of the bodies in, records as a data-acquisition card stores them out.

======= ======================================================================
module  responsibility
======= ======================================================================
rig     transfer paths and machine background of a rig
mixing  bearing and background of a record put together, compiled
measure path, modulation, background, level and converter, record by record
======= ======================================================================
"""
