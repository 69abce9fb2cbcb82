"""Copies of corpora, joined and in the forms of other programs: ``sources -> choose -> blocks -> one function per form -> target``.

============= =================================================================
module        responsibility
============= =================================================================
items         records one by one or in batches, for training
columns       columns with safe names, and the page about a copy
tables        labels and units as CSV; one file per record
csv_files     CSV
parquet_files Parquet
huggingface   Parquet by split with the card of the Hugging Face hub
zarr_store    Zarr
forms         all forms; ``copy``
============= =================================================================
"""

import lazy_loader

# xarray and netCDF4 take 0.3 s to load
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
