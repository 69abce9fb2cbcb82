from .acdd import publication_attributes as publication_attributes
from .choice import operating_variables as operating_variables
from .codecs import CODECS as CODECS, Codec as Codec
from .description import format_page as format_page
from .fault_classes import (
    FAULT_NAMES as FAULT_NAMES,
    FAULTS as FAULTS,
    UNKNOWN as UNKNOWN,
    UNKNOWN_CODE as UNKNOWN_CODE,
)
from .contents import (
    UNITS as UNITS,
    FaultCounts as FaultCounts,
    by_class as by_class,
    class_counts as class_counts,
    clipped_records as clipped_records,
    extent as extent,
    fault_counts as fault_counts,
    split_counts as split_counts,
    step_complaint as step_complaint,
    text_counts as text_counts,
    unit_counts as unit_counts,
    units_in_several_splits as units_in_several_splits,
)
from .disk import (
    check_name as check_name,
    plain_file as plain_file,
    remove_left_behind as remove_left_behind,
    remove_left_behind_of as remove_left_behind_of,
    sha256 as sha256,
    temporary_beside as temporary_beside,
    temporary_folder as temporary_folder,
    whole_folder_or_none as whole_folder_or_none,
    whole_or_not_at_all as whole_or_not_at_all,
    write_durably as write_durably,
    write_text_durably as write_text_durably,
    writing as writing,
)
from .finishing import (
    finish_corpus as finish_corpus,
    finish_file as finish_file,
    remove_parts as remove_parts,
    remove_temporary_files as remove_temporary_files,
)
from .index import corpus_name as corpus_name, open_corpus as open_corpus
from .lazy import open_part as open_part
from .locking import lock as lock
from .manifest import (
    INDEX_NAME as INDEX_NAME,
    MANIFEST_NAME as MANIFEST_NAME,
    RECIPE_NAME as RECIPE_NAME,
    Check as Check,
    Manifest as Manifest,
    corpus_files as corpus_files,
    facts_as_attributes as facts_as_attributes,
    facts_of_parts as facts_of_parts,
    file_problems as file_problems,
    read_manifest as read_manifest,
    recipe_text as recipe_text,
    record_blocks as record_blocks,
    row_of as row_of,
    write_manifest as write_manifest,
)
from .new import NewCorpus as NewCorpus, is_single_file as is_single_file, new_corpus as new_corpus
from .outputs import (
    GENERATOR as GENERATOR,
    check_new as check_new,
    check_place as check_place,
    check_result as check_result,
    check_result_folder as check_result_folder,
    make_result_folder as make_result_folder,
    result_folder as result_folder,
    write_numbers as write_numbers,
)
from .part import PartRow as PartRow, part_name as part_name, part_number as part_number, write_part as write_part
from .publication import Creator as Creator, Publication as Publication, read_publication as read_publication
from .slices import (
    RecordBlock as RecordBlock,
    file_facts as file_facts,
    read_attributes as read_attributes,
    read_channel as read_channel,
    read_classes as read_classes,
    read_columns as read_columns,
    stored_blocks as stored_blocks,
)
from .schema import (
    DRAWS as DRAWS,
    FORMAT as FORMAT,
    IDENTITY as IDENTITY,
    MISSING_COUNT as MISSING_COUNT,
    RECIPE_TEXT as RECIPE_TEXT,
    ROLES as ROLES,
    SCHEMA as SCHEMA,
    SIGNAL as SIGNAL,
    SPLITS as SPLITS,
    Variable as Variable,
    class_names as class_names,
    identity as identity,
    make_dataset as make_dataset,
)
from .unusable import (
    SignalCounts as SignalCounts,
    complaint as complaint,
    counts_in_words as counts_in_words,
    sum_counts as sum_counts,
)
from .simulated import (
    LIFE as LIFE,
    SIMULATED as SIMULATED,
)
from .trust import LIBRARY_LOCK as LIBRARY_LOCK
from .validation import validate_corpus as validate_corpus
