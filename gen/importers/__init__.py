"""Real recordings into the corpus format: a folder or a mapping file in, a corpus and an account of it out.

========== ===================================================================
module     responsibility
========== ===================================================================
cwru       Case Western Reserve University set, drive end, 12 kHz
mfpt       MFPT fault data set of Bechhoefer
generic    one's own recordings, described by a mapping file
mapping    the mapping file: keys, units, checks
matlab     one variable of a MATLAB file in whatever state
level_7_3  MATLAB files of level 7.3, which are HDF5 files
level_5    MATLAB files of level 5
apart      reading in a process apart, which a library may crash
unfolding  compressed values, unfolded within bounds
files      columns of numbers out of text and NumPy files
recordings what a recording is, what it must be, how it is cut into records
assemble   the files of a set into a corpus, whole or not at all
========== ===================================================================

An importer names its files and how to read each (:class:`~gen.importers.recordings.Candidate`);
``assemble`` reads them one after the other. A file that cannot be used is skipped with a sentence, and none
enters in part.
"""

from gen.importers.assemble import Import
from gen.importers.cwru import import_cwru
from gen.importers.generic import import_generic
from gen.importers.mfpt import import_mfpt

__all__ = ["Import", "import_cwru", "import_generic", "import_mfpt"]
