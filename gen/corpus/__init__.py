"""The corpus format: a folder of records that any netCDF-4 tool reads as one file.

=============== =============================================================
module          responsibility
=============== =============================================================
codecs          codecs of stored signals
schema          dimensions, variables, units and roles
simulated       further variables of simulated corpora
hdf5            lock of the HDF5 library, refusal of links to other files
unicode_text    global attributes with letters beyond ASCII
layout          allowed shapes, types and attributes in a file
files           atomic writing, hashes
locking         one call at a time writes into a folder
signals         records that cannot be used
part            one netCDF-4 file of records
journal         finished parts of an unfinished corpus
publication     licence, creators and references of a corpus
part_forms      descriptions from which parts are written again
packed          a corpus as one file: its parts and small files
record_hashes   SHA-256 of single records
reading         lazy reading, with a few files open at a time
record_checks   records of a packed file compared with their hashes
manifest_fields fields of the manifest
manifest        files of a corpus with size and hash
index           ``corpus.nc`` over the parts; opening a corpus
validation      all checks of a corpus
visible         faults that can be seen in their records
recoverable     labels that can be recovered from the signals
card            data card of a corpus
acdd            global attributes of a published corpus
croissant       files, fields and licence for catalogues of data sets
finishing       index, manifest and data card of finished parts
description     page about the format
=============== =============================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.corpus.acdd import publication_attributes
    from gen.corpus.card.page import data_card, write_card
    from gen.corpus.codecs import CODECS, Codec
    from gen.corpus.description import format_page
    from gen.corpus.files import (
        check_name,
        check_new_folder,
        new_corpus_folder,
        plain_file,
        remove_left_behind,
        remove_left_behind_of,
        sha256,
        temporary_beside,
        temporary_folder,
        whole_folder_or_none,
        whole_or_not_at_all,
        write_durably,
        write_text_durably,
    )
    from gen.corpus.finishing import finish_corpus, publish, remove_temporary_files
    from gen.corpus.hdf5 import LIBRARY_LOCK
    from gen.corpus.index import open_corpus, write_index
    from gen.corpus.journal import JOURNAL_NAME, new_journal
    from gen.corpus.locking import locked
    from gen.corpus.manifest import EXTENSION_NAME, part_paths, read_manifest, write_manifest
    from gen.corpus.manifest_fields import MOST_EXTENSIONS, Extension, Manifest, extensions_of
    from gen.corpus.part import PartRow, part_name, write_part
    from gen.corpus.publication import Creator, Publication, read_publication
    from gen.corpus.reading import open_part, read_channel
    from gen.corpus.schema import (
        DRAWS,
        FAULT_NAMES,
        FAULTS,
        FORMAT,
        MISSING_COUNT,
        ROLES,
        SCHEMA,
        SIGNAL,
        SPLITS,
        UNKNOWN,
        UNKNOWN_CODE,
        Variable,
        class_names,
        make_dataset,
    )
    from gen.corpus.signals import SignalCounts, complaint, described, summed
    from gen.corpus.simulated import SIMULATED
    from gen.corpus.validation import validate_corpus
    from gen.corpus.visible import FaultCounts, fault_counts

__all__ = [
    "CODECS",
    "DRAWS",
    "EXTENSION_NAME",
    "FAULTS",
    "FAULT_NAMES",
    "FORMAT",
    "JOURNAL_NAME",
    "LIBRARY_LOCK",
    "MISSING_COUNT",
    "MOST_EXTENSIONS",
    "ROLES",
    "SCHEMA",
    "SIGNAL",
    "SIMULATED",
    "SPLITS",
    "UNKNOWN",
    "UNKNOWN_CODE",
    "Codec",
    "Creator",
    "Extension",
    "FaultCounts",
    "Manifest",
    "PartRow",
    "Publication",
    "SignalCounts",
    "Variable",
    "check_name",
    "check_new_folder",
    "class_names",
    "complaint",
    "data_card",
    "described",
    "extensions_of",
    "fault_counts",
    "finish_corpus",
    "format_page",
    "locked",
    "make_dataset",
    "new_corpus_folder",
    "new_journal",
    "open_corpus",
    "open_part",
    "part_name",
    "part_paths",
    "plain_file",
    "publication_attributes",
    "publish",
    "read_channel",
    "read_manifest",
    "read_publication",
    "remove_left_behind",
    "remove_left_behind_of",
    "remove_temporary_files",
    "sha256",
    "summed",
    "temporary_beside",
    "temporary_folder",
    "validate_corpus",
    "whole_folder_or_none",
    "whole_or_not_at_all",
    "write_card",
    "write_durably",
    "write_index",
    "write_manifest",
    "write_part",
    "write_text_durably",
]

# xarray, netCDF4 and h5py take 0.3 s to load, and a recipe needs none of them
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "gen.corpus.acdd": ("publication_attributes",),
        "gen.corpus.card.page": ("data_card", "write_card"),
        "gen.corpus.description": ("format_page",),
        "gen.corpus.codecs": ("CODECS", "Codec"),
        "gen.corpus.files": (
            "check_name", "check_new_folder", "new_corpus_folder", "plain_file", "remove_left_behind", "remove_left_behind_of", "sha256",
            "temporary_beside",
            "temporary_folder", "whole_folder_or_none", "whole_or_not_at_all", "write_durably", "write_text_durably",
        ),
        "gen.corpus.finishing": ("finish_corpus", "publish", "remove_temporary_files"),
        "gen.corpus.hdf5": ("LIBRARY_LOCK",),
        "gen.corpus.index": ("open_corpus", "write_index"),
        "gen.corpus.locking": ("locked",),
        "gen.corpus.journal": ("JOURNAL_NAME", "new_journal"),
        "gen.corpus.manifest": ("EXTENSION_NAME", "part_paths", "read_manifest", "write_manifest"),
        "gen.corpus.manifest_fields": ("MOST_EXTENSIONS", "Extension", "Manifest", "extensions_of"),
        "gen.corpus.part": ("PartRow", "part_name", "write_part"),
        "gen.corpus.publication": ("Creator", "Publication", "read_publication"),
        "gen.corpus.reading": ("open_part", "read_channel"),
        "gen.corpus.schema": (
            "DRAWS", "FAULT_NAMES", "FAULTS", "FORMAT", "MISSING_COUNT", "ROLES", "SCHEMA", "SIGNAL", "SPLITS", "UNKNOWN", "UNKNOWN_CODE",
            "Variable", "class_names", "make_dataset",
        ),
        "gen.corpus.signals": ("SignalCounts", "complaint", "described", "summed"),
        "gen.corpus.simulated": ("SIMULATED",),
        "gen.corpus.validation": ("validate_corpus",),
        "gen.corpus.visible": ("FaultCounts", "fault_counts"),
    },
)  # fmt: skip
