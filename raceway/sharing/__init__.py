"""Copies of corpora, joined and in the forms of other programs: ``sources -> choose -> blocks -> one function per form -> target``.

============= ========================================================
module        responsibility
============= ========================================================
form_columns  columns of the records in another form, with safe names
copying       chosen records of one or several corpora, block by block
joining       several corpora with the same variables and new numbers
parquet_files one table as Parquet
huggingface   Parquet by split with the card of the Hugging Face hub
forms         all forms; ``copy``
card          the data card: a page, its facts and additions
croissant     files, fields and licence for catalogues of data sets
publication   licence, creators and references of a corpus
acdd          global attributes of a published corpus
publishing    terms of use; the pages that describe a corpus
card_pictures pictures and scores of a data card
copy_command  the command copy
card_command  the command card
============= ========================================================
"""

import lazy_loader

# xarray and netCDF4 take 0.3 s to load
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
