from .choice import operating_variables as operating_variables
from .codecs import CODECS as CODECS, Codec as Codec
from .fault_classes import (
    FAULT_NAMES as FAULT_NAMES,
    FAULTS as FAULTS,
    UNKNOWN as UNKNOWN,
    UNKNOWN_CODE as UNKNOWN_CODE,
)
from .contents import (
    UNITS as UNITS,
    by_class as by_class,
    class_counts as class_counts,
    extent as extent,
    numbered as numbered,
    specimen_numbers as specimen_numbers,
    unit_counts as unit_counts,
)
from .disk import (
    check_name as check_name,
    plain_file as plain_file,
    remove_left_behind_of as remove_left_behind_of,
    remove_temporary_files as remove_temporary_files,
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
    remove_parts as remove_parts,
)
from .index import corpus_name as corpus_name, open_corpus as open_corpus
from .lazy import (
    blocks_of as blocks_of,
    open_records as open_records,
    stored_records as stored_records,
)
from .locking import lock as lock
from .manifest import (
    INDEX_NAME as INDEX_NAME,
    MANIFEST_NAME as MANIFEST_NAME,
    RECIPE_NAME as RECIPE_NAME,
    Check as Check,
    Manifest as Manifest,
    corpus_files as corpus_files,
    facts_as_attributes as facts_as_attributes,
    finished as finished,
    file_problems as file_problems,
    manifest_of_parts as manifest_of_parts,
    read_manifest as read_manifest,
    recipe_text as recipe_text,
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
    clipping_complaint as clipping_complaint,
    complaint as complaint,
    counts_in_words as counts_in_words,
    sum_counts as sum_counts,
)
from .simulated import (
    LIFE as LIFE,
    SIMULATED as SIMULATED,
)
from .trust import LIBRARY_LOCK as LIBRARY_LOCK, codec_of as codec_of, file_facts as file_facts
from .validation import validate_corpus as validate_corpus
