"""Corpora that travel: cut, joined, packed into one file, exported to other formats.

=========== ======================================================
module      responsibility
=========== ======================================================
where       conditions on records: parsed, never evaluated as Python
choice      choice of records and channels
=========== ======================================================
"""
