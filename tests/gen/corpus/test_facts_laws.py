"""Facts of a corpus: counts of its units, classes, splits and faults that can be seen, as all pages and commands give them."""

import numpy as np
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from gen.corpus import FAULT_NAMES, FAULTS, by_class, class_counts, unit_counts
from raceway.console.corpus_counts import FaultCounts, fault_counts, units_in_several_splits

INNER, HEALTHY = FAULTS.index("inner"), FAULTS.index("healthy")
COLUMNS = {
    "fault": [INNER, INNER, INNER, INNER, HEALTHY, HEALTHY],
    "detectable": [1, 1, 0, 2, 0, 0],
    "rig": [0, 0, 0, 1, 1, 1],
    "specimen": [0, 0, 1, 0, 3, 3],
    "fault_tries": [2, 2, 0, 1, 0, 0],
    "level_tries": [0, 3, 0, 0, 0, 0],
}
NUMBER = st.integers(0, 2)
ROWS = st.lists(st.tuples(st.sampled_from([*FAULT_NAMES]), NUMBER, NUMBER, NUMBER, NUMBER), min_size=1, max_size=20)
NAMES = ("fault", "rig", "specimen", "recording", "split")


def corpus_of(columns):
    return xr.Dataset({name: ("record", np.array(values)) for name, values in columns.items()})


def columns_of(rows):
    return dict(zip(NAMES, np.array(rows).T, strict=True))


@given(rows=ROWS)
def test_a_specimen_is_numbered_in_its_rig_and_a_recording_in_its_specimen(rows):
    keys = [row[1:4] for row in rows]
    expected = (len(rows), len(set(keys)), len({key[:2] for key in keys}), len({key[0] for key in keys}))
    assert unit_counts(columns_of(rows)) == unit_counts(corpus_of(columns_of(rows))) == expected


@given(rows=ROWS)
def test_the_records_of_all_classes_are_those_of_the_corpus(rows):
    columns = columns_of(rows)
    classes = by_class(columns, NAMES)
    assert {name: len(of["rig"]) for name, of in classes.items()} == class_counts(columns["fault"])
    assert sorted(row for of in classes.values() for row in zip(*of.values(), strict=True)) == sorted(rows)


@given(rows=ROWS)
def test_a_unit_is_in_several_splits_if_two_of_its_records_are(rows):
    def several(key):
        return any(key(one) == key(other) and one[4] != other[4] for one in rows for other in rows)

    found = {"rig": several(lambda row: row[1]), "specimen": several(lambda row: row[1:3])}
    assert units_in_several_splits(columns_of(rows)) == [name for name, divided in found.items() if divided]


def test_faults_are_counted_by_record_and_redrawn_faults_by_specimen():
    assert fault_counts(corpus_of(COLUMNS)) == FaultCounts(4, 2, 1, 2, 1)


def test_a_corpus_without_faults_or_of_recordings_has_no_counts():
    healthy = COLUMNS | {"fault": [HEALTHY] * 6}
    assert fault_counts(corpus_of(healthy)) is None
    assert fault_counts(corpus_of({"fault": [INNER], "specimen": [0]})) is None
