"""The corpus format: records in, a folder that any netCDF-4 tool reads as one file, and the same records out.

========== =====================================================
module     responsibility
========== =====================================================
schema     dimensions, variables, units and roles
simulated  further variables of simulated corpora
hdf5       one thread at a time, values of the file itself only
layout     what a file of a corpus may hold
files      written whole or not at all, known by their hash
signals    whether a stored signal can be used
part       one self-describing netCDF-4 file of records
manifest   which files belong to a corpus, with size and hash
reading    records read when touched, a few files open at a time
index      ``corpus.nc`` over the parts, opening
validation everything that can be checked of a corpus
card       the data card of a corpus, and the page about the format
========== =====================================================
"""

from gen.corpus.card import data_card, format_page
from gen.corpus.files import (
    check_name,
    plain_file,
    remove_left_behind,
    sha256,
    temporary_beside,
    whole_or_not_at_all,
    write_durably,
    write_text_durably,
)
from gen.corpus.hdf5 import LIBRARY_LOCK
from gen.corpus.index import open_corpus, write_index
from gen.corpus.manifest import Manifest, part_paths, read_manifest, write_manifest
from gen.corpus.part import Codec, PartRow, part_name, write_part
from gen.corpus.reading import open_part, read_channel
from gen.corpus.schema import (
    DRAWS,
    FAULTS,
    FORMAT,
    MISSING_COUNT,
    ROLES,
    SCHEMA,
    SIGNAL,
    SPLITS,
    Variable,
    make_dataset,
)
from gen.corpus.signals import SignalCounts, complaint, described, summed
from gen.corpus.simulated import SIMULATED
from gen.corpus.validation import validate_corpus

__all__ = [
    "DRAWS",
    "FAULTS",
    "FORMAT",
    "LIBRARY_LOCK",
    "MISSING_COUNT",
    "ROLES",
    "SCHEMA",
    "SIGNAL",
    "SIMULATED",
    "SPLITS",
    "Codec",
    "Manifest",
    "PartRow",
    "SignalCounts",
    "Variable",
    "check_name",
    "complaint",
    "data_card",
    "described",
    "format_page",
    "make_dataset",
    "open_corpus",
    "open_part",
    "part_name",
    "part_paths",
    "plain_file",
    "read_channel",
    "read_manifest",
    "remove_left_behind",
    "sha256",
    "summed",
    "temporary_beside",
    "validate_corpus",
    "whole_or_not_at_all",
    "write_durably",
    "write_index",
    "write_manifest",
    "write_part",
    "write_text_durably",
]
