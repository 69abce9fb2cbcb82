"""Corpora that travel: cut, joined, packed into one file, exported to other formats.

=========== ======================================================
module      responsibility
=========== ======================================================
where       conditions on records: parsed, never evaluated as Python
choice      choice of records and channels
exporting   corpora in the forms of other programs
packing     a whole corpus written into one netCDF-4 file
unpacking   the folder of a packed corpus made again
portable    a corpus, or a choice of it, as one file
=========== ======================================================
"""
