"""The corpus format: netCDF-4 files of records, one alone or several in a folder.

============= ======================================================================
module        responsibility
============= ======================================================================
codecs        codecs of stored signals
fault_classes names of the fault classes, and their codes
schema        dimensions, variables, units and roles
simulated     further variables that readers know
trust         the one look at a file before anything reads it; lock of the libraries
disk          atomic writing, checksums
locking       one call at a time writes into a folder
outputs       places of results, none of them in a corpus
unusable      records that cannot be used
contents      what a corpus holds, counted from its variables
part          one file of records
lazy          records as a Dataset, read lazily, with a few files open
manifest      files of a corpus with size and hash, and its facts
index         opening a corpus
xarray_engine the same for xarray, by the name of an engine
finishing     index and manifest of finished parts, or one file of them
new           a new corpus, part by part
where         conditions on records: parsed, never run
choice        choice of records and channels
items         records one by one or in batches, for training
plain_arrays  plain arrays in and out
numbering     numbers of machines, bearings and recordings
validation    all checks of a corpus
============= ======================================================================
"""

import lazy_loader

# xarray, netCDF4 and h5py take 0.3 s to load, and a recipe needs none of them
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
