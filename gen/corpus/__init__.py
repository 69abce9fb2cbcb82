"""The corpus format: records in, a folder that any netCDF-4 tool reads as one file, and the same records out.

======== =====================================================
module   responsibility
======== =====================================================
schema   dimensions, variables, units and roles
signals  whether a stored signal can be used
part     one self-describing netCDF-4 file of records
index    manifest, ``corpus.nc`` over the parts, opening, checks
card     the data card of a corpus, and the page about the format
======== =====================================================
"""

from gen.corpus.card import data_card, format_page
from gen.corpus.index import (
    open_corpus,
    part_paths,
    read_manifest,
    validate_corpus,
    write_index,
    write_manifest,
)
from gen.corpus.part import (
    Codec,
    PartRow,
    describe_part,
    open_part,
    part_name,
    sha256,
    write_durably,
    write_part,
    write_text_durably,
)
from gen.corpus.schema import (
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

__all__ = [
    "FAULTS",
    "FORMAT",
    "MISSING_COUNT",
    "ROLES",
    "SCHEMA",
    "SIGNAL",
    "SPLITS",
    "Codec",
    "PartRow",
    "SignalCounts",
    "Variable",
    "complaint",
    "data_card",
    "describe_part",
    "described",
    "format_page",
    "make_dataset",
    "open_corpus",
    "open_part",
    "part_name",
    "part_paths",
    "read_manifest",
    "sha256",
    "summed",
    "validate_corpus",
    "write_durably",
    "write_index",
    "write_manifest",
    "write_part",
    "write_text_durably",
]
