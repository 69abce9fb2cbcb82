"""The corpus format: netCDF-4 files of records, one alone or several in a folder.

=============== =============================================================
module          responsibility
=============== =============================================================
codecs          codecs of stored signals
schema          dimensions, variables, units and roles
simulated       further variables of simulated corpora
hdf5            lock of the HDF5 library, refusal of links to other files
unicode_text    global attributes with letters beyond ASCII
layout          allowed shapes, types and attributes in a file
files           atomic writing, checksums
locking         one call at a time writes into a folder
outputs         places of results, none of them in a corpus
signals         records that cannot be used
step_errors     records whose step is too coarse
part            one file of records
open_files      files that are open, a few at a time
blocks          stored records of a file, some at a time
reading         records as a Dataset, read lazily
publication     licence, creators and references of a corpus
manifest        files of a corpus with size and hash, and its facts
acdd            global attributes of a published corpus
index           the variables of all parts in one file; opening a corpus
visible         faults that can be seen in their records
recoverable     labels that can be recovered from the signals
card            data card of a corpus
croissant       files, fields and licence for catalogues of data sets
finishing       index, manifest and data card of finished parts
new             a new corpus, part by part
where           conditions on records: parsed, never run
choice          choice of records and channels
joining         several corpora with the same variables and new numbers
copying         chosen records of one or several corpora, block by block
validation      all checks of a corpus
description     page about the format
=============== =============================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from gen.corpus.acdd import publication_attributes
    from gen.corpus.blocks import RecordBlock, read_channel, stored_blocks, stored_columns
    from gen.corpus.card.page import card_folder, check_card, data_card, write_card
    from gen.corpus.codecs import CODECS, Codec
    from gen.corpus.croissant import write_croissant
    from gen.corpus.description import format_page
    from gen.corpus.files import (
        check_name,
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
        writing,
    )
    from gen.corpus.finishing import finish_corpus, finish_file, publish, remove_parts, remove_temporary_files
    from gen.corpus.hdf5 import LIBRARY_LOCK
    from gen.corpus.index import open_corpus
    from gen.corpus.layout import stored_signal
    from gen.corpus.locking import locked
    from gen.corpus.manifest import (
        INDEX_NAME,
        MANIFEST_NAME,
        RECIPE_NAME,
        Check,
        Manifest,
        corpus_files,
        facts_as_attributes,
        facts_of_parts,
        read_manifest,
        recipe_text,
        record_blocks,
        row_of,
        write_manifest,
    )
    from gen.corpus.new import NewCorpus, is_single_file, new_corpus
    from gen.corpus.open_files import file_facts
    from gen.corpus.outputs import (
        GENERATOR,
        check_new,
        check_place,
        check_result,
        check_result_folder,
        make_result_folder,
        write_numbers,
    )
    from gen.corpus.part import PartRow, part_name, write_part
    from gen.corpus.publication import Creator, Publication, read_publication
    from gen.corpus.reading import open_part
    from gen.corpus.schema import (
        DRAWS,
        FAULT_NAMES,
        FAULTS,
        FORMAT,
        IDENTITY,
        MISSING_COUNT,
        ROLES,
        SCHEMA,
        SIGNAL,
        SPLITS,
        UNKNOWN,
        UNKNOWN_CODE,
        Variable,
        class_names,
        identity,
        make_dataset,
    )
    from gen.corpus.signals import SignalCounts, complaint, described, summed
    from gen.corpus.simulated import SIMULATED
    from gen.corpus.step_errors import step_complaint
    from gen.corpus.validation import validate_corpus
    from gen.corpus.visible import FaultCounts, fault_counts

__all__ = [
    "CODECS",
    "DRAWS",
    "FAULTS",
    "FAULT_NAMES",
    "FORMAT",
    "GENERATOR",
    "IDENTITY",
    "INDEX_NAME",
    "LIBRARY_LOCK",
    "MANIFEST_NAME",
    "MISSING_COUNT",
    "RECIPE_NAME",
    "ROLES",
    "SCHEMA",
    "SIGNAL",
    "SIMULATED",
    "SPLITS",
    "UNKNOWN",
    "UNKNOWN_CODE",
    "Check",
    "Codec",
    "Creator",
    "FaultCounts",
    "Manifest",
    "NewCorpus",
    "PartRow",
    "Publication",
    "RecordBlock",
    "SignalCounts",
    "Variable",
    "card_folder",
    "check_card",
    "check_name",
    "check_new",
    "check_place",
    "check_result",
    "check_result_folder",
    "class_names",
    "complaint",
    "corpus_files",
    "data_card",
    "described",
    "facts_as_attributes",
    "facts_of_parts",
    "fault_counts",
    "file_facts",
    "finish_corpus",
    "finish_file",
    "format_page",
    "identity",
    "is_single_file",
    "locked",
    "make_dataset",
    "make_result_folder",
    "new_corpus",
    "open_corpus",
    "open_part",
    "part_name",
    "plain_file",
    "publication_attributes",
    "publish",
    "read_channel",
    "read_manifest",
    "read_publication",
    "recipe_text",
    "record_blocks",
    "remove_left_behind",
    "remove_left_behind_of",
    "remove_parts",
    "remove_temporary_files",
    "row_of",
    "sha256",
    "step_complaint",
    "stored_blocks",
    "stored_columns",
    "stored_signal",
    "summed",
    "temporary_beside",
    "temporary_folder",
    "validate_corpus",
    "whole_folder_or_none",
    "whole_or_not_at_all",
    "write_card",
    "write_croissant",
    "write_durably",
    "write_manifest",
    "write_numbers",
    "write_part",
    "write_text_durably",
    "writing",
]

# xarray, netCDF4 and h5py take 0.3 s to load, and a recipe needs none of them
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "gen.corpus.acdd": ("publication_attributes",),
        "gen.corpus.blocks": ("RecordBlock", "read_channel", "stored_blocks", "stored_columns"),
        "gen.corpus.card.page": ("card_folder", "check_card", "data_card", "write_card"),
        "gen.corpus.codecs": ("CODECS", "Codec"),
        "gen.corpus.croissant": ("write_croissant",),
        "gen.corpus.description": ("format_page",),
        "gen.corpus.files": (
            "check_name", "plain_file", "remove_left_behind", "remove_left_behind_of", "sha256", "temporary_beside", "temporary_folder",
            "whole_folder_or_none", "whole_or_not_at_all", "write_durably", "write_text_durably", "writing",
        ),
        "gen.corpus.finishing": ("finish_corpus", "finish_file", "publish", "remove_parts", "remove_temporary_files"),
        "gen.corpus.hdf5": ("LIBRARY_LOCK",),
        "gen.corpus.index": ("open_corpus",),
        "gen.corpus.layout": ("stored_signal",),
        "gen.corpus.locking": ("locked",),
        "gen.corpus.manifest": (
            "INDEX_NAME", "MANIFEST_NAME", "RECIPE_NAME", "Check", "Manifest", "corpus_files", "facts_as_attributes",
            "facts_of_parts", "read_manifest", "recipe_text", "record_blocks", "row_of", "write_manifest",
        ),
        "gen.corpus.new": ("NewCorpus", "is_single_file", "new_corpus"),
        "gen.corpus.open_files": ("file_facts",),
        "gen.corpus.outputs": (
            "GENERATOR", "check_new", "check_place", "check_result", "check_result_folder", "make_result_folder", "write_numbers",
        ),
        "gen.corpus.part": ("PartRow", "part_name", "write_part"),
        "gen.corpus.publication": ("Creator", "Publication", "read_publication"),
        "gen.corpus.reading": ("open_part",),
        "gen.corpus.schema": (
            "DRAWS", "FAULTS", "FAULT_NAMES", "FORMAT", "IDENTITY", "MISSING_COUNT", "ROLES", "SCHEMA", "SIGNAL", "SPLITS", "UNKNOWN",
            "UNKNOWN_CODE", "Variable", "class_names", "identity", "make_dataset",
        ),
        "gen.corpus.signals": ("SignalCounts", "complaint", "described", "summed"),
        "gen.corpus.simulated": ("SIMULATED",),
        "gen.corpus.step_errors": ("step_complaint",),
        "gen.corpus.validation": ("validate_corpus",),
        "gen.corpus.visible": ("FaultCounts", "fault_counts"),
    },
)  # fmt: skip
