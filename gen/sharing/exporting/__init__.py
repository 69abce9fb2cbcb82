"""Corpora in the forms of other programs: ``corpus -> choose -> blocks -> one function per form -> folder``.

============= =================================================================
module        responsibility
============= =================================================================
choosing      chosen records in blocks, names of their columns
report        progress, and the page about an export
tables        labels and units as CSV; one file per record
csv_files     CSV
wav_files     WAV
matlab_files  MATLAB and Octave
parquet_files Parquet
huggingface   Parquet by split with the card of the Hugging Face hub
zarr_store    Zarr
forms         all forms; ``export``
============= =================================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.sharing.exporting.forms import FORMS, Exported, export

__all__ = ["FORMS", "Exported", "export"]

__getattr__, __dir__ = lazy_names(__name__, {"gen.sharing.exporting.forms": ("FORMS", "Exported", "export")})
