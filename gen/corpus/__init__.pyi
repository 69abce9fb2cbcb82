from .acdd import publication_attributes as publication_attributes
from .blocks import (
    RecordBlock as RecordBlock,
)
from .blocks import (
    read_channel as read_channel,
)
from .blocks import (
    stored_blocks as stored_blocks,
)
from .blocks import (
    stored_columns as stored_columns,
)
from .card.page import (
    card_folder as card_folder,
)
from .card.page import (
    check_card as check_card,
)
from .card.page import (
    data_card as data_card,
)
from .card.page import (
    write_card as write_card,
)
from .codecs import CODECS as CODECS
from .codecs import Codec as Codec
from .croissant import write_croissant as write_croissant
from .description import format_page as format_page
from .files import (
    check_name as check_name,
)
from .files import (
    plain_file as plain_file,
)
from .files import (
    remove_left_behind as remove_left_behind,
)
from .files import (
    remove_left_behind_of as remove_left_behind_of,
)
from .files import (
    sha256 as sha256,
)
from .files import (
    temporary_beside as temporary_beside,
)
from .files import (
    temporary_folder as temporary_folder,
)
from .files import (
    whole_folder_or_none as whole_folder_or_none,
)
from .files import (
    whole_or_not_at_all as whole_or_not_at_all,
)
from .files import (
    write_durably as write_durably,
)
from .files import (
    write_text_durably as write_text_durably,
)
from .files import (
    writing as writing,
)
from .finishing import (
    finish_corpus as finish_corpus,
)
from .finishing import (
    finish_file as finish_file,
)
from .finishing import (
    publish as publish,
)
from .finishing import (
    remove_parts as remove_parts,
)
from .finishing import (
    remove_temporary_files as remove_temporary_files,
)
from .hdf5 import LIBRARY_LOCK as LIBRARY_LOCK
from .index import open_corpus as open_corpus
from .layout import stored_signal as stored_signal
from .locking import locked as locked
from .manifest import (
    INDEX_NAME as INDEX_NAME,
)
from .manifest import (
    MANIFEST_NAME as MANIFEST_NAME,
)
from .manifest import (
    RECIPE_NAME as RECIPE_NAME,
)
from .manifest import (
    Check as Check,
)
from .manifest import (
    Manifest as Manifest,
)
from .manifest import (
    corpus_files as corpus_files,
)
from .manifest import (
    facts_as_attributes as facts_as_attributes,
)
from .manifest import (
    facts_of_parts as facts_of_parts,
)
from .manifest import (
    read_manifest as read_manifest,
)
from .manifest import (
    recipe_text as recipe_text,
)
from .manifest import (
    record_blocks as record_blocks,
)
from .manifest import (
    row_of as row_of,
)
from .manifest import (
    write_manifest as write_manifest,
)
from .new import NewCorpus as NewCorpus
from .new import is_single_file as is_single_file
from .new import new_corpus as new_corpus
from .open_files import file_facts as file_facts
from .outputs import (
    GENERATOR as GENERATOR,
)
from .outputs import (
    check_new as check_new,
)
from .outputs import (
    check_place as check_place,
)
from .outputs import (
    check_result as check_result,
)
from .outputs import (
    check_result_folder as check_result_folder,
)
from .outputs import (
    make_result_folder as make_result_folder,
)
from .outputs import (
    write_numbers as write_numbers,
)
from .part import PartRow as PartRow
from .part import part_name as part_name
from .part import write_part as write_part
from .publication import Creator as Creator
from .publication import Publication as Publication
from .publication import read_publication as read_publication
from .reading import open_part as open_part
from .schema import (
    DRAWS as DRAWS,
)
from .schema import (
    FAULT_NAMES as FAULT_NAMES,
)
from .schema import (
    FAULTS as FAULTS,
)
from .schema import (
    FORMAT as FORMAT,
)
from .schema import (
    IDENTITY as IDENTITY,
)
from .schema import (
    MISSING_COUNT as MISSING_COUNT,
)
from .schema import (
    ROLES as ROLES,
)
from .schema import (
    SCHEMA as SCHEMA,
)
from .schema import (
    SIGNAL as SIGNAL,
)
from .schema import (
    SPLITS as SPLITS,
)
from .schema import (
    UNKNOWN as UNKNOWN,
)
from .schema import (
    UNKNOWN_CODE as UNKNOWN_CODE,
)
from .schema import (
    Variable as Variable,
)
from .schema import (
    class_names as class_names,
)
from .schema import (
    identity as identity,
)
from .schema import (
    make_dataset as make_dataset,
)
from .signals import SignalCounts as SignalCounts
from .signals import complaint as complaint
from .signals import described as described
from .signals import summed as summed
from .simulated import SIMULATED as SIMULATED
from .step_errors import step_complaint as step_complaint
from .validation import validate_corpus as validate_corpus
from .visible import FaultCounts as FaultCounts
from .visible import fault_counts as fault_counts
