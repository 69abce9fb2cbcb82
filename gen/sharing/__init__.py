"""Corpora selected, merged, packed into one file, exported to the formats of other programs.

============= ======================================================
module        responsibility
============= ======================================================
where         conditions on records: parsed, never evaluated as Python
choice        choice of records and channels
items         records one by one or in batches, for training
copying       stored records, recipes and facts of one corpus for another
columns       variables of all corpora that are merged
repeats       records with the same samples in different corpora
selecting     some records or channels as a corpus of their own
merging       several corpora as one
packing       a whole corpus written into one netCDF-4 file
unpacking     the folder of a packed corpus made again
packed_choice a corpus, or a choice of it, as one file
exporting     corpora in the forms that other programs read
============= ======================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.sharing.choice import chosen_channels, chosen_records
    from gen.sharing.exporting import Exported, export
    from gen.sharing.items import LabelledRecords, torch_dataset
    from gen.sharing.merging import Merged, merge
    from gen.sharing.packed_choice import pack
    from gen.sharing.packing import PackedFile
    from gen.sharing.selecting import Selected, select
    from gen.sharing.unpacking import Unpacked, unpack
    from gen.sharing.where import Condition, parse_where

__all__ = [
    "Condition",
    "Exported",
    "LabelledRecords",
    "Merged",
    "PackedFile",
    "Selected",
    "Unpacked",
    "chosen_channels",
    "chosen_records",
    "export",
    "merge",
    "pack",
    "parse_where",
    "select",
    "torch_dataset",
    "unpack",
]

# xarray and netCDF4 take 0.3 s to load, and a condition needs none of them
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "gen.sharing.choice": ("chosen_channels", "chosen_records"),
        "gen.sharing.items": ("LabelledRecords", "torch_dataset"),
        "gen.sharing.exporting": ("Exported", "export"),
        "gen.sharing.merging": ("Merged", "merge"),
        "gen.sharing.packing": ("PackedFile",),
        "gen.sharing.packed_choice": ("pack",),
        "gen.sharing.selecting": ("Selected", "select"),
        "gen.sharing.unpacking": ("Unpacked", "unpack"),
        "gen.sharing.where": ("Condition", "parse_where"),
    },
)
