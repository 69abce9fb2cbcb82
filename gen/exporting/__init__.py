"""Copies of corpora, joined and in the forms of other programs: ``sources -> choose -> blocks -> one function per form -> target``.

============= =================================================================
module        responsibility
============= =================================================================
items         records one by one or in batches, for training
columns       columns with safe names, and the page about a copy
tables        labels and units as CSV; one file per record
csv_files     CSV
wav_files     WAV
matlab_files  MATLAB and Octave
parquet_files Parquet
huggingface   Parquet by split with the card of the Hugging Face hub
zarr_store    Zarr
forms         all forms; ``copy``
============= =================================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.exporting.forms import FORMS, Copied, copy
    from gen.exporting.items import LabelledRecords, torch_dataset

__all__ = ["FORMS", "Copied", "LabelledRecords", "copy", "torch_dataset"]

# xarray and netCDF4 take 0.3 s to load
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "gen.exporting.forms": ("FORMS", "Copied", "copy"),
        "gen.exporting.items": ("LabelledRecords", "torch_dataset"),
    },
)
