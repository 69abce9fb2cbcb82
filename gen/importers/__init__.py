"""Importers: recordings of real machines, converted into the corpus format.

========== ===================================================================
module     responsibility
========== ===================================================================
cwru       Case Western Reserve University set, drive end, 12 kHz
mfpt       MFPT fault data set of Bechhoefer
generic    recordings of the user, described by a mapping file
mapping    the mapping file: keys, units, checks
signals    one recording of the user, in m/s^2
conversion from the unit of a file to m/s^2
wav        WAV files
matlab     one variable of a MATLAB file
level_7_3  MATLAB files of level 7.3, which are HDF5 files
level_5    MATLAB files of level 5
apart      reading in a child process, which a library may crash
unfolding  decompression within bounds
files      columns of text and NumPy files
recordings recordings, their checks, their division into records
assemble   recordings written as a corpus
========== ===================================================================

An importer lists its files with a function that reads each (:class:`~gen.importers.recordings.Candidate`); ``assemble`` reads them one
after the other. A file that cannot be used is skipped as a whole, with a sentence.
"""

from gen.importers.assemble import Import
from gen.importers.cwru import import_cwru
from gen.importers.generic import import_generic
from gen.importers.mfpt import import_mfpt
from gen.importers.signals import Signal, read_signal

__all__ = ["Import", "Signal", "import_cwru", "import_generic", "import_mfpt", "read_signal"]
